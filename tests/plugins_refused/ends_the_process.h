/// Code that runs when the library is loaded. A plugin that is refused by its header must never get that far.
#pragma once

#include <cstdlib>

namespace {
struct EndsTheProcess {
  EndsTheProcess() { std::abort(); }
} const ends_the_process;
}  // namespace
