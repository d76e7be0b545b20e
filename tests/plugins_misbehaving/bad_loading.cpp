// A plugin that crashes while it is loaded.
#include "dismantle/plugin.h"

namespace {
struct Crashes {
  Crashes() {
    volatile int* volatile nowhere = nullptr;
    *nowhere = 1;
  }
} const crashes;
}  // namespace

DISMANTLE_PLUGIN("bad.loading", "1.0.0", "MIT", "https://example.org/bad") {}
