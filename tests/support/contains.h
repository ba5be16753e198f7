// Whether a text contains a part, with both in the message of a failed test.
#pragma once

#include <string>

#include <gtest/gtest.h>

namespace buoyancy {

inline ::testing::AssertionResult contains(const std::string& text, const std::string& part) {
  const bool found = text.find(part) != std::string::npos;
  return (found ? ::testing::AssertionSuccess() : ::testing::AssertionFailure())
         << "'" << part << "' is " << (found ? "" : "not ") << "in: " << text;
}

}  // namespace buoyancy
