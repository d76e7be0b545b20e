/// A test assembly of boxes: one part blocks another and cannot leave itself.
#pragma once

#include "dismantle/testing/fake_planning.h"

namespace dismantle {

/// A drawer in a shaft below a bar. The bar is captive in a guide, but can slide off the shaft by 2.
inline Assembly barred_shaft() {
  return fake::assembly_of({{"frame",
                             {{{-3, -2, -1}, {6, 2, 0}},
                              {{-3, -2, 0}, {-1, 2, 2}},
                              {{1, -2, 0}, {6, 2, 1}},
                              {{-1, -2, 0}, {1, -1, 1}},
                              {{-1, 1, 0}, {1, 2, 1}},
                              {{-1, -2, 1}, {6, -1, 2}},
                              {{-1, 1, 1}, {6, 2, 2}},
                              {{5, -1, 1}, {6, 1, 2}},
                              {{-3, -2, 2}, {-1, 2, 3}},
                              {{1, -2, 2}, {6, 2, 3}},
                              {{-1, -2, 2}, {1, -1, 3}},
                              {{-1, 1, 2}, {1, 2, 3}}}},
                            {"bar", {{{-0.9, -0.9, 1.1}, {2.9, 0.9, 1.9}}}},
                            {"drawer", {{{-0.9, -0.9, 0.1}, {0.9, 0.9, 0.9}}}}});
}

}  // namespace dismantle
