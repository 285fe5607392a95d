#pragma once

namespace luciole {

/// While it lives, what this process writes to standard error is lost: for libraries that write there what a
/// program tells in its own words.
class QuietStderr {
 public:
  QuietStderr();
  ~QuietStderr();
  QuietStderr(const QuietStderr&) = delete;
  QuietStderr& operator=(const QuietStderr&) = delete;

 private:
  int kept_;  ///< standard error; -1: nothing was changed
};

}  // namespace luciole
