// The film of a plan.
#include <gtest/gtest.h>

#include "dismantle/book/book.h"
#include "dismantle/errors.h"
#include "row_plan.h"

namespace dismantle {
namespace {

/// Pictures in a GIF: blocks of image descriptors, by walking through the file as its standard says.
std::size_t pictures_in(const std::string& gif) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(gif.at(i)); };
  std::size_t at = 13 + 3 * 256, pictures = 0;
  const auto skip_blocks = [&] {
    for (; byte(at) != 0; at += byte(at) + 1u) {
    }
    ++at;
  };
  for (; byte(at) != 0x3b;) {
    if (byte(at) == 0x21)
      at += 2;
    else if (byte(at) == 0x2c)
      at += 11, ++pictures;
    else
      throw Error("no block of a GIF");
    skip_blocks();
  }
  return pictures;
}

TEST(Film, ShowsEachStep) {
  std::mt19937 random(23);
  const Assembly assembly = row_of(4);
  const Plan plan = random_plan(assembly, random);
  FilmOptions options;
  options.width = 160, options.height = 120;
  std::size_t steps = 0;
  options.on_step = [&](std::size_t step, std::size_t count) {
    EXPECT_EQ(step, ++steps);
    EXPECT_EQ(count, plan.disassembly.size());
  };
  const std::string gif = book_gif(plan, assembly, options);
  EXPECT_EQ(gif.substr(0, 6), "GIF89a");
  EXPECT_EQ(static_cast<unsigned char>(gif[6]), 160);
  EXPECT_GE(pictures_in(gif), 10 * steps) << "it moves, whatever the number of poses";
  EXPECT_NE(gif.find("NETSCAPE2.0"), std::string::npos) << "it repeats";
  EXPECT_EQ(steps, plan.disassembly.size());
  steps = 0;
  EXPECT_EQ(gif, book_gif(plan, assembly, options));
  options.on_step = [](std::size_t, std::size_t) { throw Error("stopped"); };
  EXPECT_THROW(book_gif(plan, assembly, options), Error);
}

}  // namespace
}  // namespace dismantle
