// SPDX-License-Identifier: Apache-2.0
#include "kontur/shape/plain_sha256.h"
#include "kontur/shape/sha256.h"

namespace kontur {

struct Sha256::State {
    PlainSha256 hash;
};

Sha256::Sha256() : state_(std::make_unique<State>()) {}

Sha256::~Sha256() = default;

void Sha256::update(std::span<const std::byte> bytes) { state_->hash.update(bytes); }

std::string Sha256::hex() const { return state_->hash.hex(); }

}  // namespace kontur
