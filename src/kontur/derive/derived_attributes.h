// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kontur/derive/derive.h"
#include "kontur/shape/structure_attributes.h"

namespace kontur {

/// What files say of a structure that a rule made: that it was made automatically, and how; its type, where the name begins
/// with GTV, CTV or PTV, or is BODY or EXTERNAL. Without a colour.
StructureAttributes derived_attributes(const DerivedStructure& derived);

}  // namespace kontur
