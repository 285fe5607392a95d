#pragma once

#include <gtest/gtest.h>

#include <string>

#include "luciole/error.hpp"

namespace luciole::test {

/// What the Error says that a function throws. Empty where it throws none, and where it throws another kind,
/// which fails the test.
template <class Error, class Function>
std::string messageOf(Function&& function) {
  try {
    function();
  } catch (const Error& error) {
    return error.what();
  } catch (const std::exception& error) {
    ADD_FAILURE() << "another kind of error: " << error.what();
  }
  return "";
}

}  // namespace luciole::test
