#pragma once
#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "base/error.h"

namespace lumi::test {

/// Runs `action` and checks that it throws Error of that kind, whose text contains each of `parts`.
inline void expectError(ErrorKind kind, const std::function<void()>& action,
                        const std::initializer_list<std::string>& parts = {}) {
    try {
        action();
        ADD_FAILURE() << "nothing was thrown";
    } catch (const Error& error) {
        EXPECT_EQ(error.exitCode(), static_cast<int>(kind)) << error.what();
        for (const std::string& part : parts)
            EXPECT_NE(std::string(error.what()).find(part), std::string::npos)
                << '"' << part << "\" in: " << error.what();
    } catch (const std::exception& other) {
        ADD_FAILURE() << "threw something else: " << other.what();
    }
}

}  // namespace lumi::test
