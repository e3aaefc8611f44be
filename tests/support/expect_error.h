// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "kontur/base/error.h"

/// Expects the statement to throw an Error of this kind whose message contains `part`.
#define EXPECT_KONTUR_ERROR(statement, expected_kind, part)                                     \
    do {                                                                                        \
        try {                                                                                   \
            static_cast<void>(statement);                                                       \
            ADD_FAILURE() << "no Error: " #statement;                                           \
        } catch (const kontur::Error& error) {                                                  \
            EXPECT_EQ(kontur::name(error.kind()), kontur::name(expected_kind)) << error.what(); \
            EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what(); \
        }                                                                                       \
    } while (false)
