#include "base/sha256.hpp"

#include <gtest/gtest.h>

#include <string>

namespace luciole::test {
namespace {

std::string sha256(const std::string& text) {
  Sha256 hash;
  hash.add(text.data(), text.size());
  return hash.hex();
}

// The examples of FIPS 180-4 that NIST publishes, and its long message.
TEST(Sha256, IsNists) {
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(sha256(std::string(1000000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256, PiecesAddUpAndHexStartsAnew) {
  Sha256 hash;
  for (const char c : {'a', 'b', 'c'}) hash.add(&c, 1);
  EXPECT_EQ(hash.hex(), sha256("abc"));
  EXPECT_EQ(hash.hex(), sha256(""));
}

}  // namespace
}  // namespace luciole::test
