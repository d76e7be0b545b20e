// Tables of standard sizes, in millimetres.
#pragma once

#include <optional>
#include <span>
#include <string>

namespace dismantle::fasteners {

/// A thread with the nominal dimensions of the parts made for it. 0: not in the tables.
struct Thread {
  const char* name;
  double diameter, pitch;
  double nut;                     ///< across flats, ISO 4032, ASME B18.2.2
  double nut_old;                 ///< the same, DIN 934
  double cap, key;                ///< head diameter and hex key, ISO 4762, ASME B18.3
  double button, button_key;      ///< ISO 7380
  double flat;                    ///< countersunk head, ISO 10642
  double set_key;                 ///< ISO 4026
  double pan;                     ///< ISO 7045
  double knurl_high, knurl_flat;  ///< DIN 464, 653
  double washer, washer_outer, washer_large,
      washer_small;  ///< ISO 7089: hole and outside; outside of ISO 7093, ISO 7092
  bool inch;

  double minor() const { return diameter - 1.0825 * pitch; }  ///< of the internal thread
  double root() const { return diameter - 1.2269 * pitch; }   ///< of the external thread
};

std::span<const Thread> threads();

/// A deep groove ball bearing or miniature bearing: bore, outside, width.
struct BearingSize {
  const char* name;
  double bore, outside, width;
};
/// The bearing of these dimensions within 2 % (the width within 20 %).
const BearingSize* bearing_of(double bore, double outside, double width);

/// Diameter in ISO 2338, ISO 8734 within 2 %; 0: none.
double pin_diameter(double diameter);

/// The standard length within 2 % or 0.1 mm, else the length to a tenth of a millimetre.
double nominal_length(double length, bool inch);

/// Number of the Torx recess whose points are `diameter` apart within 8 %; 0: none.
int torx_number(double diameter);

/// "3", "2.5", "3.175".
std::string number(double value);

}  // namespace dismantle::fasteners
