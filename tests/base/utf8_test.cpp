#include "base/utf8.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "base/dump_utf8.hpp"
#include "base/text_file.hpp"

namespace luciole {
namespace {

TEST(Utf8, IsKeptAndAllElseIsTakenAsLatin1) {
  for (const std::string text :
       {"", "plain", "gr\xc3\xbcn", "\xe2\x82\xac", "\xf0\x9f\x94\xa5", "\xed\x9f\xbf", "\xf4\x8f\xbf\xbf"}) {
    EXPECT_TRUE(isUtf8(text)) << text;
    EXPECT_EQ(utf8Of(text), text);
  }
  EXPECT_EQ(utf8Of("gr\xfcn"), "gr\xc3\xbcn");
  EXPECT_EQ(utf8Of("\xff"), "\xc3\xbf");
  EXPECT_EQ(utf8Of("gr\xfcn gr\xc3\xbcn"), "gr\xc3\xbcn gr\xc3\xbcn") << "a Latin-1 path and a name in UTF-8";
  // Too long, a surrogate, beyond Unicode, cut off, a byte that continues nothing.
  for (const std::string text : {"\xc0\xaf", "\xe0\x80\xaf", "\xed\xa0\x80", "\xf4\x90\x80\x80",
                                 "\xf5\x80\x80\x80", "\xe2\x82", "\x80"}) {
    EXPECT_FALSE(isUtf8(text)) << text;
    EXPECT_TRUE(isUtf8(utf8Of(text))) << text;
  }
}

TEST(Utf8, EveryTwoBytesBecomeValidJson) {
  for (int i = 0; i < 0x10000; ++i) {
    const std::string text{char(i >> 8), char(i & 255)};
    const nlohmann::json json{{text, {text}}};
    EXPECT_NO_THROW(EXPECT_EQ(nlohmann::json::parse(dumpUtf8(json))[utf8Of(text)][0], utf8Of(text))) << i;
  }
}

TEST(Utf8, MessagesAreCutBetweenCharacters) {
  const std::string cut = forMessage(std::string(199, 'a') + "\xc3\xbc and more");
  EXPECT_EQ(cut, std::string(199, 'a'));
  EXPECT_EQ(forMessage("gr\xfcn\n"), "gr\xc3\xbcn");
}

TEST(Utf8, MessagesHoldNoControlCharacters) {
  EXPECT_EQ(forMessage("a\x1b[1mb\x7f\x9b"
                       "1m\xc2\x85\xc2\xa0z"),
            "a [1mb  1m \xc2\xa0z");
}

}  // namespace
}  // namespace luciole
