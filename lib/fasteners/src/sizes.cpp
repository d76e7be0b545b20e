#include "sizes.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace dismantle::fasteners {
namespace {

constexpr std::array kThreads{
    //      name  d  pitch  nut  old  cap  key  button key  flat  set  pan  464 653  hole outer large small
    Thread{"M1", 1, .25, 2.5, 2.5, 2, .9, 0, 0, 0, 0, 0, 0, 0, 1.1, 2.5, 0, 2.2, false},
    Thread{"M1.2", 1.2, .25, 3, 3, 2.3, .9, 0, 0, 0, 0, 0, 0, 0, 1.3, 3, 0, 2.5, false},
    Thread{"M1.4", 1.4, .3, 3, 3, 2.6, 1.3, 0, 0, 0, .7, 0, 0, 0, 1.5, 3, 0, 2.8, false},
    Thread{"M1.6", 1.6, .35, 3.2, 3.2, 3, 1.5, 0, 0, 3, .7, 3.2, 0, 0, 1.7, 4, 0, 3.5, false},
    Thread{"M2", 2, .4, 4, 4, 3.8, 1.5, 3.5, 1.3, 3.8, .9, 4, 9, 9, 2.2, 5, 6, 4.5, false},
    Thread{"M2.5", 2.5, .45, 5, 5, 4.5, 2, 4.7, 1.5, 4.7, 1.3, 5, 11, 11, 2.7, 6, 8, 5, false},
    Thread{"M3", 3, .5, 5.5, 5.5, 5.5, 2.5, 5.7, 2, 5.5, 1.5, 5.6, 12, 12, 3.2, 7, 9, 6, false},
    Thread{"M3.5", 3.5, .6, 6, 6, 6, 0, 0, 0, 6.5, 1.8, 7, 0, 0, 3.7, 8, 11, 7, false},
    Thread{"M4", 4, .7, 7, 7, 7, 3, 7.6, 2.5, 7.5, 2, 8, 16, 16, 4.3, 9, 12, 8, false},
    Thread{"M5", 5, .8, 8, 8, 8.5, 4, 9.5, 3, 9.4, 2.5, 9.5, 20, 20, 5.3, 10, 15, 9, false},
    Thread{"M6", 6, 1, 10, 10, 10, 5, 10.5, 4, 11.3, 3, 12, 24, 24, 6.4, 12, 18, 11, false},
    Thread{"M8", 8, 1.25, 13, 13, 13, 6, 14, 5, 15.2, 4, 16, 30, 30, 8.4, 16, 24, 15, false},
    Thread{"M10", 10, 1.5, 16, 17, 16, 8, 17.5, 6, 19.2, 5, 20, 36, 36, 10.5, 20, 30, 18, false},
    Thread{"M12", 12, 1.75, 18, 19, 18, 10, 21, 8, 23.1, 6, 0, 0, 0, 13, 24, 37, 20, false},
    Thread{"M14", 14, 2, 21, 22, 21, 12, 0, 0, 26.5, 0, 0, 0, 0, 15, 28, 44, 24, false},
    Thread{"M16", 16, 2, 24, 24, 24, 14, 28, 10, 29, 8, 0, 0, 0, 17, 30, 50, 28, false},
    Thread{"M18", 18, 2.5, 27, 27, 27, 14, 0, 0, 0, 0, 0, 0, 0, 19, 34, 56, 30, false},
    Thread{"M20", 20, 2.5, 30, 30, 30, 17, 0, 0, 36, 10, 0, 0, 0, 21, 37, 60, 34, false},
    Thread{"M22", 22, 2.5, 34, 32, 33, 17, 0, 0, 0, 0, 0, 0, 0, 23, 39, 66, 37, false},
    Thread{"M24", 24, 3, 36, 36, 36, 19, 0, 0, 0, 12, 0, 0, 0, 25, 44, 72, 39, false},
    Thread{"M27", 27, 3, 41, 41, 40, 19, 0, 0, 0, 0, 0, 0, 0, 28, 50, 85, 44, false},
    Thread{"M30", 30, 3.5, 46, 46, 45, 22, 0, 0, 0, 0, 0, 0, 0, 31, 56, 92, 50, false},
    Thread{"M36", 36, 4, 55, 55, 54, 27, 0, 0, 0, 0, 0, 0, 0, 37, 66, 110, 60, false},
    Thread{"#2-56", 2.184, .4536, 4.76, 4.76, 3.56, 1.98, 4.17, 1.27, 4.37, .89, 4.24, 0, 0, 2.44, 6.35, 0, 0, true},
    Thread{"#4-40", 2.845, .635, 6.35, 6.35, 4.65, 2.38, 5.41, 1.59, 5.72, 1.27, 5.56, 0, 0, 3.18, 7.94, 9.53, 5.3,
           true},
    Thread{"#6-32", 3.505, .794, 7.94, 7.94, 5.74, 2.78, 6.65, 1.98, 7.09, 1.59, 6.86, 0, 0, 3.96, 9.53, 11.1, 6.8,
           true},
    Thread{"#8-32", 4.166, .794, 8.73, 8.73, 6.86, 3.57, 7.92, 2.38, 8.43, 1.98, 8.18, 0, 0, 4.76, 11.1, 12.7, 0, true},
    Thread{"#10-24", 4.826, 1.058, 9.53, 9.53, 7.92, 3.97, 9.17, 3.18, 9.78, 2.38, 9.47, 0, 0, 5.56, 12.7, 14.3, 0,
           true},
    Thread{"1/4-20", 6.35, 1.27, 11.11, 11.11, 9.53, 4.76, 11.1, 3.97, 12.8, 3.18, 12.5, 0, 0, 7.14, 15.9, 18.6, 0,
           true},
    Thread{"5/16-18", 7.938, 1.411, 12.7, 12.7, 11.91, 6.35, 13.9, 4.76, 16.1, 3.97, 15.6, 0, 0, 8.73, 17.5, 22.2, 0,
           true},
    Thread{"3/8-16", 9.525, 1.588, 14.29, 14.29, 14.29, 7.94, 16.7, 5.56, 19.3, 4.76, 18.8, 0, 0, 10.3, 20.6, 25.4, 0,
           true},
    Thread{"1/2-13", 12.7, 1.954, 19.05, 19.05, 19.05, 9.53, 22.2, 7.94, 24.4, 6.35, 0, 0, 0, 13.5, 27, 34.9, 0, true},
    Thread{"5/8-11", 15.875, 2.309, 23.81, 23.81, 23.81, 12.7, 0, 0, 0, 7.94, 0, 0, 0, 16.7, 33.3, 44.5, 0, true},
    Thread{"3/4-10", 19.05, 2.54, 28.58, 28.58, 28.58, 15.88, 0, 0, 0, 9.53, 0, 0, 0, 20.6, 37.3, 50.8, 0, true},
};

constexpr std::array kBearings{
    BearingSize{"681", 1, 3, 1},     BearingSize{"692", 2, 6, 2.3},    BearingSize{"623", 3, 10, 4},
    BearingSize{"693", 3, 8, 4},     BearingSize{"683", 3, 7, 3},      BearingSize{"MR63", 3, 6, 2.5},
    BearingSize{"684", 4, 9, 4},     BearingSize{"694", 4, 11, 4},     BearingSize{"624", 4, 13, 5},
    BearingSize{"MR84", 4, 8, 3},    BearingSize{"685", 5, 11, 5},     BearingSize{"695", 5, 13, 4},
    BearingSize{"605", 5, 14, 5},    BearingSize{"625", 5, 16, 5},     BearingSize{"MR105", 5, 10, 4},
    BearingSize{"MR95", 5, 9, 3},    BearingSize{"MR115", 5, 11, 4},   BearingSize{"686", 6, 13, 5},
    BearingSize{"696", 6, 15, 5},    BearingSize{"606", 6, 17, 6},     BearingSize{"626", 6, 19, 6},
    BearingSize{"MR106", 6, 10, 3},  BearingSize{"MR126", 6, 12, 4},   BearingSize{"687", 7, 14, 5},
    BearingSize{"697", 7, 17, 5},    BearingSize{"607", 7, 19, 6},     BearingSize{"627", 7, 22, 7},
    BearingSize{"688", 8, 16, 5},    BearingSize{"698", 8, 19, 6},     BearingSize{"608", 8, 22, 7},
    BearingSize{"628", 8, 24, 8},    BearingSize{"MR128", 8, 12, 3.5}, BearingSize{"MR148", 8, 14, 4},
    BearingSize{"689", 9, 17, 5},    BearingSize{"609", 9, 24, 7},     BearingSize{"629", 9, 26, 8},
    BearingSize{"6800", 10, 19, 5},  BearingSize{"6900", 10, 22, 6},   BearingSize{"6000", 10, 26, 8},
    BearingSize{"6200", 10, 30, 9},  BearingSize{"6300", 10, 35, 11},  BearingSize{"6801", 12, 21, 5},
    BearingSize{"6901", 12, 24, 6},  BearingSize{"6001", 12, 28, 8},   BearingSize{"6201", 12, 32, 10},
    BearingSize{"6301", 12, 37, 12}, BearingSize{"6802", 15, 24, 5},   BearingSize{"6902", 15, 28, 7},
    BearingSize{"6002", 15, 32, 9},  BearingSize{"6202", 15, 35, 11},  BearingSize{"6302", 15, 42, 13},
    BearingSize{"6803", 17, 26, 5},  BearingSize{"6903", 17, 30, 7},   BearingSize{"6003", 17, 35, 10},
    BearingSize{"6203", 17, 40, 12}, BearingSize{"6303", 17, 47, 14},  BearingSize{"6804", 20, 32, 7},
    BearingSize{"6904", 20, 37, 9},  BearingSize{"6004", 20, 42, 12},  BearingSize{"6204", 20, 47, 14},
    BearingSize{"6304", 20, 52, 15}, BearingSize{"6805", 25, 37, 7},   BearingSize{"6905", 25, 42, 9},
    BearingSize{"6005", 25, 47, 12}, BearingSize{"6205", 25, 52, 15},  BearingSize{"6305", 25, 62, 17},
    BearingSize{"6806", 30, 42, 7},  BearingSize{"6906", 30, 47, 9},   BearingSize{"6006", 30, 55, 13},
    BearingSize{"6206", 30, 62, 16}, BearingSize{"6306", 30, 72, 19},  BearingSize{"6007", 35, 62, 14},
    BearingSize{"6207", 35, 72, 17}, BearingSize{"6008", 40, 68, 15},  BearingSize{"6208", 40, 80, 18},
    BearingSize{"6009", 45, 75, 16}, BearingSize{"6209", 45, 85, 19},  BearingSize{"6010", 50, 80, 16},
    BearingSize{"6210", 50, 90, 20},
};

bool near(double a, double b, double share) { return std::abs(a - b) <= share * b; }

}  // namespace

std::span<const Thread> threads() { return kThreads; }

const BearingSize* bearing_of(double bore, double outside, double width) {
  for (const BearingSize& b : kBearings)
    if (near(bore, b.bore, 0.02) && near(outside, b.outside, 0.02) && near(width, b.width, 0.2)) return &b;
  return nullptr;
}

double pin_diameter(double diameter) {
  for (const double d : {0.6, 0.8, 1., 1.2, 1.5, 2., 2.5, 3., 4., 5., 6., 8., 10., 12., 16., 20., 25., 30.})
    if (near(diameter, d, 0.02)) return d;
  return 0;
}

double nominal_length(double length, bool inch) {
  double best = 0;
  const auto offer = [&](double l) {
    if (best == 0 || std::abs(length - l) < std::abs(length - best)) best = l;
  };
  if (inch) {
    const double step = length < 40 ? 25.4 / 16 : 25.4 / 4;
    offer(std::max(1.0, std::round(length / step)) * step);
  } else {
    for (const double l : {2., 2.5, 3., 4., 5., 6., 7., 8., 9., 10., 12., 14., 16., 18.}) offer(l);
    if (length > 19) offer(5 * std::round(length / 5));
    if (length > 19) offer(2 * std::round(length / 2));
  }
  if (std::abs(best - length) <= std::max(0.1, 0.02 * best) && (inch || std::abs(best - length) < 0.5)) return best;
  return std::round(10 * length) / 10;
}

int torx_number(double diameter) {
  struct Torx {
    int number;
    double points;
  };
  constexpr std::array kTorx{Torx{3, 1.2},   Torx{4, 1.35},  Torx{5, 1.5},  Torx{6, 1.75},  Torx{7, 2.08},
                             Torx{8, 2.4},   Torx{9, 2.58},  Torx{10, 2.8}, Torx{15, 3.35}, Torx{20, 3.95},
                             Torx{25, 4.5},  Torx{27, 5.07}, Torx{30, 5.6}, Torx{40, 6.75}, Torx{45, 7.93},
                             Torx{50, 8.95}, Torx{55, 11.35}};
  const Torx* best = nullptr;
  for (const Torx& t : kTorx)
    if (near(diameter, t.points, 0.08) &&
        (best == nullptr || std::abs(diameter - t.points) < std::abs(diameter - best->points)))
      best = &t;
  return best == nullptr ? 0 : best->number;
}

std::string number(double value) { return fmt::format("{:.4g}", std::round(value * 1000) / 1000); }

}  // namespace dismantle::fasteners
