// SPDX-License-Identifier: Apache-2.0
#include "kontur/shape/sha256.h"

#include <openssl/evp.h>

#include <array>
#include <new>

namespace kontur {
namespace {

struct Deleter {
    void operator()(EVP_MD_CTX* context) const { EVP_MD_CTX_free(context); }
};
using Context = std::unique_ptr<EVP_MD_CTX, Deleter>;

/// Nothing but a lack of memory makes libcrypto fail at this.
void check(bool done) {
    if (!done) throw std::bad_alloc();
}

Context new_context() {
    Context context(EVP_MD_CTX_new());
    check(context != nullptr);
    return context;
}

}  // namespace

struct Sha256::State {
    Context context = new_context();
};

Sha256::Sha256() : state_(std::make_unique<State>()) {
    check(EVP_DigestInit_ex(state_->context.get(), EVP_sha256(), nullptr) == 1);
}

Sha256::~Sha256() = default;

void Sha256::update(std::span<const std::byte> bytes) {
    check(EVP_DigestUpdate(state_->context.get(), bytes.data(), bytes.size()) == 1);
}

std::string Sha256::hex() const {
    const Context copy = new_context();
    std::array<unsigned char, 32> digest;
    check(EVP_MD_CTX_copy_ex(copy.get(), state_->context.get()) == 1 &&
          EVP_DigestFinal_ex(copy.get(), digest.data(), nullptr) == 1);
    std::string text;
    for (const unsigned byte : digest) {
        text += "0123456789abcdef"[byte >> 4];
        text += "0123456789abcdef"[byte & 15];
    }
    return text;
}

}  // namespace kontur
