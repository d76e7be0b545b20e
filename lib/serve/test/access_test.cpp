#include "access.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace dismantle::serve {
namespace {

TEST(Access, TokensDifferAndAreCompared) {
  std::set<std::string> tokens;
  for (int i = 0; i < 100; ++i) tokens.insert(new_token());
  EXPECT_EQ(tokens.size(), 100u);
  for (const std::string& token : tokens) {
    EXPECT_EQ(token.size(), 32u);
    EXPECT_EQ(token.find_first_not_of("0123456789abcdef"), std::string::npos);
    EXPECT_TRUE(same_token(std::string(token), token));
    EXPECT_FALSE(same_token("", token));
    EXPECT_FALSE(same_token(token.substr(1), token));
    EXPECT_FALSE(same_token(token + "0", token));
    for (std::size_t i = 0; i < token.size(); ++i) {
      std::string other = token;
      other[i] = other[i] == '0' ? '1' : '0';
      EXPECT_FALSE(same_token(other, token));
    }
  }
}

TEST(Access, OnlyItsOwnAddressIsAllowed) {
  for (const char* host : {"127.0.0.1:8000", "localhost:8000"}) {
    EXPECT_TRUE(allowed_host(host, 8000)) << host;
    EXPECT_TRUE(allowed_origin(std::string("http://") + host, 8000)) << host;
    EXPECT_FALSE(allowed_origin(std::string("https://") + host, 8000)) << host;
    EXPECT_FALSE(allowed_origin(host, 8000)) << host;
  }
  for (const char* host :
       {"", "127.0.0.1", "localhost", "127.0.0.1:8001", "127.0.0.1:80000", "evil.example:8000",
        "127.0.0.1:8000.evil.example", "127.0.0.1.evil.example:8000", "0.0.0.0:8000", "[::1]:8000"}) {
    EXPECT_FALSE(allowed_host(host, 8000)) << host;
    EXPECT_FALSE(allowed_origin(std::string("http://") + host, 8000)) << host;
  }
  EXPECT_TRUE(allowed_origin("", 8000)) << "a program sends none";
  EXPECT_FALSE(allowed_origin("null", 8000)) << "a sandboxed page";
}

TEST(Access, NamesAreThoseOfFilesInTheFolder) {
  for (const char* name : {"gear.step", "Getriebe 2.STEP", "gear", "a..b", "Gehäuse.stl"})
    EXPECT_TRUE(plain_name(name)) << name;
  for (const char* name :
       {"", ".", "..", "../gear.step", "/etc/passwd", "a/b", "a\\b", ".hidden", "a\nb", "a\x7f", "\xff.step"})
    EXPECT_FALSE(plain_name(name)) << name;
  EXPECT_FALSE(plain_name(std::string("a\0b", 3)));
  EXPECT_TRUE(plain_name(std::string(200, 'a')));
  EXPECT_FALSE(plain_name(std::string(201, 'a')));
}

}  // namespace
}  // namespace dismantle::serve
