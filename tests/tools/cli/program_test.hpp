#pragma once

#include <gtest/gtest.h>

#include <string>

#include "luciole/image.hpp"
#include "tools/cli/run_program.hpp"

namespace luciole::test {

/// Runs the program by shell lines, as runLine() does, in a folder of its own.
class ProgramTest : public testing::Test {
 protected:
  /// Expects success and returns what was printed.
  Outcome run(const std::string& line) {
    Outcome outcome = runLine(folder, line);
    EXPECT_EQ(outcome.status, 0) << line << "\n" << outcome.err;
    return outcome;
  }

  /// The same, only its standard output.
  std::string succeed(const std::string& line) { return run(line).out; }

  /// The same, only its standard error.
  std::string told(const std::string& line) { return run(line).err; }

  /// The program's standard output under Oclgrind, which interprets OpenCL; `line` is what follows "luciole".
  /// Tried again where Oclgrind crashes, by a signal or told by the program, or takes minutes instead of
  /// seconds: Oclgrind 21.10 makes and frees buffers of several threads at once without a lock, and a loop
  /// over one that it lost may never end.
  std::string underOclgrind(const std::string& line) {
    Outcome outcome;
    for (int tries = 0; tries < 4; ++tries) {
      outcome = runLine(folder,
                        "timeout -s KILL 120 oclgrind --build-options '-disable-llvm-passes -DSTANDARD_ONLY' "
                        "'" LUCIOLE_BINARY "' " +
                            line);
      if (outcome.status < 128 && outcome.err.find("luciole: a library ") == std::string::npos) break;
    }
    EXPECT_EQ(outcome.status, 0) << line << "\n" << outcome.err;
    return outcome.out;
  }

  /// Expects one line on standard error that mentions `what`, and this exit status.
  void refuse(const std::string& line, int status, const std::string& what) {
    const Outcome outcome = runLine(folder, line);
    EXPECT_EQ(outcome.status, status) << line << "\n" << outcome.err;
    EXPECT_TRUE(isOneLine(outcome.err)) << line << "\n" << outcome.err;
    EXPECT_NE(outcome.err.find(what), std::string::npos) << line << "\n" << outcome.err;
  }

  /// Expects the same channels and pixels in both pictures, bit for bit. Quicker than `luciole compare` of
  /// two EXR files, which loads OpenImageIO anew each time.
  void expectSamePicture(const std::string& a, const std::string& b) {
    const Image one = readImage(folder / a), other = readImage(folder / b);
    EXPECT_EQ(one.width, other.width) << a << ", " << b;
    EXPECT_EQ(one.channels, other.channels) << a << ", " << b;
    EXPECT_TRUE(one.pixels == other.pixels) << a << ", " << b;
  }

  const TemporaryFolder folder;
};

}  // namespace luciole::test
