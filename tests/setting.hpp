#pragma once

#include <cstdlib>
#include <optional>
#include <string>

namespace luciole::test {

/// Sets a variable of the environment, or removes it, until the end of the test.
class Setting {
 public:
  Setting(const char* name, const std::optional<std::string>& value) : name_(name) {
    if (const char* old = std::getenv(name)) old_ = old;
    set(value);
  }
  ~Setting() { set(old_); }

 private:
  void set(const std::optional<std::string>& value) {
    value ? setenv(name_, value->c_str(), 1) : unsetenv(name_);
  }
  const char* name_;
  std::optional<std::string> old_;
};

}  // namespace luciole::test
