// Laws of objects that plugins share: one for each name, as long as it has an owner.
#include "dismantle/shared_object.h"

#include <gtest/gtest.h>

#include <atomic>
#include <set>
#include <thread>
#include <vector>

namespace dismantle {
namespace {

TEST(SharedObject, OnePerNameWhileItIsHeld) {
  int made = 0;
  const auto make = [&] {
    ++made;
    return std::make_shared<int>(made);
  };
  auto a = shared_object("test.a", make), again = shared_object("test.a", make), b = shared_object("test.b", make);
  EXPECT_EQ(a, again);
  EXPECT_NE(a, b);
  EXPECT_EQ(made, 2);
  a.reset();
  EXPECT_EQ(*std::static_pointer_cast<int>(shared_object("test.a", make)), 1);  // `again` holds it
  again.reset();
  EXPECT_EQ(*std::static_pointer_cast<int>(shared_object("test.a", make)), 3);
}

TEST(SharedObject, TheSameForAllThreads) {
  for (int round = 0; round < 20; ++round) {
    std::atomic<int> made{0};
    std::vector<std::shared_ptr<void>> got(8);
    std::vector<std::thread> threads;
    for (auto& one : got)
      threads.emplace_back([&] {
        one = shared_object("test.threads", [&] {
          ++made;
          return std::make_shared<int>(0);
        });
      });
    for (auto& thread : threads) thread.join();
    EXPECT_EQ(made, 1);
    EXPECT_EQ(std::set(got.begin(), got.end()).size(), 1u);
  }
}

}  // namespace
}  // namespace dismantle
