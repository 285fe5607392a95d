#pragma once

#include <cstddef>
#include <memory>
#include <string>

namespace luciole {

/// SHA-256 (FIPS 180-4) of bytes that come in pieces.
class Sha256 {
 public:
  Sha256();
  ~Sha256();

  void add(const void* bytes, std::size_t count);

  /// Of all bytes so far, as 64 digits 0-9a-f. It starts anew then.
  std::string hex();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace luciole
