// SPDX-License-Identifier: Apache-2.0
// A shared library needs a source of its own; everything else comes from the static one.
