/// What has to hold of every input: broken, and the fuzzer keeps the input.
#pragma once

#include <cstdio>
#include <cstdlib>

#define FUZZ_EXPECT(condition)                                                                                \
  do {                                                                                                        \
    if (!(condition)) {                                                                                       \
      std::fprintf(stderr, "%s:%d: expected: %s\n", __FILE__, __LINE__, #condition);                          \
      std::abort();                                                                                           \
    }                                                                                                         \
  } while (false)
