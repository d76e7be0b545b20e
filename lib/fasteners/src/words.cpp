#include "words.h"

#include <algorithm>
#include <array>
#include <span>

namespace dismantle::fasteners {
namespace {

using enum Kind;

// Sorted.
constexpr std::array kIsoScrews{299,   1207,  1479,  1481,  1482,  1483,  1580,  2009,  2010,  2342,  4014,  4015,
                                4016,  4017,  4018,  4026,  4027,  4028,  4029,  4162,  4762,  4766,  7045,  7046,
                                7047,  7048,  7049,  7050,  7051,  7379,  7380,  7434,  7435,  7436,  8676,  8765,
                                10642, 12474, 14579, 14580, 14581, 14582, 14583, 14584, 14585, 14586, 14587, 15071};
constexpr std::array kIsoNuts{4032, 4033, 4034, 4035, 4036, 4161, 4775,  7040,  7041,  7042,  7043,  7044, 7413,
                              7414, 7719, 7720, 8673, 8674, 8675, 10511, 10512, 10513, 10663, 12125, 12126};
constexpr std::array kIsoWashers{887, 7089, 7090, 7091, 7092, 7093, 7094, 7415, 7416, 8738, 10669, 10673};
constexpr std::array kIsoPins{1234, 2338, 2339, 2340, 2341, 8733, 8734, 8735, 8736, 8737, 8739, 8740, 8741,
                              8742, 8743, 8744, 8745, 8746, 8747, 8748, 8749, 8750, 8751, 8752, 13337};
constexpr std::array kDinScrews{84,   85,   86,   186,  261,  316,  404,  417,  427,  438,  444,  464,  465,  478,
                                479,  480,  525,  551,  553,  558,  561,  564,  571,  580,  601,  603,  604,  605,
                                607,  608,  609,  610,  653,  835,  912,  913,  914,  915,  916,  920,  921,  922,
                                923,  926,  931,  933,  938,  939,  940,  960,  961,  963,  964,  965,  966,  975,
                                976,  3404, 6912, 6914, 6921, 7500, 7504, 7513, 7516, 7964, 7968, 7969, 7971, 7972,
                                7973, 7976, 7981, 7982, 7983, 7984, 7985, 7990, 7991, 7999};
constexpr std::array kDinNuts{315, 431, 439,  466,  467,  508,  546,  547,  548,  555,  557,  562,  582, 917,
                              918, 928, 929,  934,  935,  936,  937,  970,  971,  972,  979,  980,  981, 982,
                              985, 986, 1587, 1804, 6330, 6331, 6334, 6915, 6923, 6924, 6925, 6926, 6927};
constexpr std::array kDinWashers{93,   125,  126,  127,  128,  134,  137,  432,  433,  434,  435,  436,  440,
                                 463,  470,  522,  988,  1440, 1441, 6319, 6340, 6796, 6797, 6798, 6902, 6903,
                                 6904, 6905, 6906, 6907, 6908, 6916, 6917, 6918, 7349, 7603, 7980, 7989, 9021};
constexpr std::array kDinPins{1,    7,    94,   1433, 1434, 1435, 1436, 1443, 1444, 1445, 1470, 1471, 1472, 1473,
                              1474, 1475, 1476, 1477, 1481, 6325, 7343, 7344, 7346, 7977, 7978, 7979, 11024};
constexpr std::array kDinRings{471, 472, 6799, 5417, 7993, 9045};
constexpr std::array kDinBearings{615, 617, 618, 620, 622, 625, 628, 630, 635, 711, 715, 720, 728, 5401, 5405, 5412};

bool among(std::span<const int> sorted, int number) {
  return std::find(sorted.begin(), sorted.end(), number) != sorted.end();
}

constexpr std::optional<Kind> kNothing{};

// A word of a kind, and below words that say that the part is something else.
constexpr std::array kWords{
    Word{"screw", screw, false},
    Word{"bolt", screw, false},
    Word{"schraube", screw, false},
    Word{"schrauben", screw, false},
    Word{"gewindestift", screw, false},
    Word{"verschraubung", screw, true},
    Word{"shcs", screw, true},
    Word{"bhcs", screw, true},
    Word{"fhcs", screw, true},
    Word{"thumbscrew", screw, false},
    Word{"vis", screw, true},
    Word{"boulon", screw, true},
    Word{"tornillo", screw, true},
    Word{"perno", screw, true},
    Word{"vite", screw, true},
    Word{"viti", screw, true},
    Word{"parafuso", screw, true},
    Word{"skruv", screw, false},
    Word{"skrue", screw, false},
    Word{"schroef", screw, false},
    Word{"\u0432\u0438\u043d\u0442", screw, true},
    Word{"\u0431\u043e\u043b\u0442", screw, true},
    Word{"\u87ba\u9489", screw, false},
    Word{"\u87ba\u4e1d", screw, false},
    Word{"\u87ba\u6813", screw, false},
    Word{"\u30dc\u30eb\u30c8", screw, false},
    Word{"nut", nut, true},
    Word{"locknut", nut, false},
    Word{"nyloc", nut, true},
    Word{"mutter", nut, false},
    Word{"muttern", nut, false},
    Word{"ecrou", nut, true},
    Word{"\u00e9crou", nut, true},
    Word{"tuerca", nut, true},
    Word{"dado", nut, true},
    Word{"porca", nut, true},
    Word{"moer", nut, true},
    Word{"\u0433\u0430\u0439\u043a\u0430", nut, true},
    Word{"\u87ba\u6bcd", nut, false},
    Word{"\u30ca\u30c3\u30c8", nut, false},
    Word{"washer", washer, false},
    Word{"shim", washer, true},
    Word{"scheibe", washer, false},
    Word{"scheiben", washer, false},
    Word{"rondelle", washer, true},
    Word{"arandela", washer, true},
    Word{"rondella", washer, true},
    Word{"rosetta", washer, true},
    Word{"ring", kNothing, true},
    Word{"\u0448\u0430\u0439\u0431\u0430", washer, true},
    Word{"\u57ab\u5708", washer, false},
    Word{"\u57ab\u7247", washer, false},
    Word{"spacer", spacer, false},
    Word{"bushing", spacer, true},
    Word{"distanzh\u00fclse", spacer, false},
    Word{"distanzhuelse", spacer, false},
    Word{"entretoise", spacer, true},
    Word{"standoff", standoff, false},
    Word{"abstandsbolzen", standoff, false},
    Word{"pin", pin, true},
    Word{"dowel", pin, true},
    Word{"stift", pin, false},
    Word{"rivet", pin, true},
    Word{"goupille", pin, true},
    Word{"circlip", ring, true},
    Word{"o-ring", ring, true},
    Word{"oring", ring, true},
    Word{"sicherungsring", ring, false},
    Word{"seegerring", ring, false},
    Word{"collar", collar, true},
    Word{"stellring", collar, false},
    Word{"coupling", coupling, true},
    Word{"coupler", coupling, true},
    Word{"kupplung", coupling, false},
    Word{"bearing", bearing, true},
    Word{"kugellager", bearing, false},
    Word{"lager", bearing, false},
    Word{"roulement", bearing, true},
    Word{"rodamiento", bearing, true},
    Word{"cuscinetto", bearing, true},
    Word{"gear", gear, true},
    Word{"sprocket", gear, true},
    Word{"pinion", gear, true},
    Word{"zahnrad", gear, false},
    Word{"pulley", pulley, true},
    Word{"idler", pulley, true},
    Word{"riemenscheibe", pulley, false},
    Word{"wheel", wheel, true},
    Word{"spring", spring, true},
    Word{"feder", spring, false},
    Word{"ressort", spring, true},
    Word{"belt", belt, true},
    Word{"riemen", belt, false},
    Word{"shaft", shaft, true},
    Word{"axle", shaft, true},
    Word{"leadscrew", shaft, false},
    Word{"welle", shaft, true},
    Word{"rod", shaft, true},
    Word{"rail", rail, true},
    Word{"extrusion", rail, true},
    Word{"insert", insert, true},
    Word{"motor", motor, true},
    Word{"stepper", motor, true},
    Word{"servo", motor, true},
    Word{"pcb", board, true},
    Word{"pcba", board, true},
    Word{"platine", board, true},
    Word{"board", board, true},
    Word{"plate", plate, true},
    Word{"faceplate", plate, true},
    Word{"baseplate", plate, true},
    Word{"platte", plate, false},
    Word{"housing", housing, true},
    Word{"enclosure", housing, true},
    Word{"geh\u00e4use", housing, false},
    Word{"gehaeuse", housing, false},
    Word{"gearbox", housing, true},
    // Something else, although its name has such a word before these.
    Word{"battery", other, true},
    Word{"batterie", other, true},
    Word{"akku", other, false},
    Word{"bateria", other, true},
    Word{"14500", other, true},  // sizes of cells
    Word{"18650", other, true},
    Word{"21700", other, true},
    Word{"26650", other, true},
    Word{"holder", kNothing, true},
    Word{"cover", kNothing, true},
    Word{"mount", kNothing, true},
    Word{"bracket", kNothing, true},
    Word{"guide", kNothing, true},
    Word{"tool", kNothing, true},
    Word{"plunger", kNothing, true},
    Word{"block", kNothing, true},
    Word{"screwdriver", kNothing, true},
    Word{"retainer", kNothing, true},
    Word{"tensioner", kNothing, true},
    Word{"clamp", kNothing, true},
    Word{"hole", kNothing, true},
    Word{"support", kNothing, true},
    Word{"adapter", kNothing, true},
    Word{"lid", kNothing, true},
    Word{"knob", kNothing, true},
    Word{"halter", kNothing, false},
    Word{"halterung", kNothing, false},
    Word{"lagerbock", kNothing, false},
    Word{"base", kNothing, true},
    Word{"tray", kNothing, true},
    Word{"case", kNothing, true},
    Word{"frame", kNothing, true},
    Word{"arm", kNothing, true},
    Word{"seat", kNothing, true},
    Word{"lever", kNothing, true},
    Word{"handle", kNothing, true},
    Word{"connector", kNothing, true},
    Word{"header", kNothing, true},
    Word{"terminal", kNothing, true},
};

}  // namespace

std::optional<Kind> kind_of_standard(std::string_view body, int number) {
  if (body == "iso") {
    if (among(kIsoScrews, number)) return screw;
    if (among(kIsoNuts, number)) return nut;
    if (among(kIsoWashers, number)) return washer;
    if (among(kIsoPins, number)) return pin;
    if (number == 3601) return ring;
    if (number == 15) return bearing;
  } else if (body == "din") {
    if (among(kDinScrews, number)) return screw;
    if (among(kDinNuts, number)) return nut;
    if (among(kDinWashers, number)) return washer;
    if (among(kDinPins, number)) return pin;
    if (among(kDinRings, number)) return ring;
    if (among(kDinBearings, number)) return bearing;
  }
  return std::nullopt;
}

const Word* word_of(std::string_view token) {
  const Word* best = nullptr;
  for (const Word& word : kWords) {
    const bool is = token == word.text ||
                    (token.size() == word.text.size() + 1 && token.starts_with(word.text) && token.back() == 's');
    const bool ends = !word.whole && (token.ends_with(word.text) ||
                                      (token.ends_with('s') && token.substr(0, token.size() - 1).ends_with(word.text)));
    // The longest word: a leadscrew is no screw.
    if ((is || ends) && (best == nullptr || word.text.size() > best->text.size())) best = &word;
  }
  return best;
}

}  // namespace dismantle::fasteners
