/// Units of length: one table for what importers read, and for plans, books and exports.
#pragma once

#include <string>
#include <string_view>

#include "dismantle/export.h"

namespace dismantle {

/// Name here of a unit under one of its usual names, in any case: "mm" for "millimeter", "Millimetres", "MM"; "um" for
/// "micron". The names are um, mm, cm, dm, m, km, mil, inch, foot, mile. Empty for any other text.
DISMANTLE_API std::string unit_named(std::string_view text);

/// Metres in a unit. @throws InputError for a text that unit_named() does not know, with the list of units.
DISMANTLE_API double metres_in(std::string_view unit);

/// Name of the unit that is `metres` long; empty for any other length.
DISMANTLE_API std::string unit_of_length(double metres);

/// The unit in which people state the lengths of an assembly that is given in `unit` and is `size` of them large:
/// millimetres for a gearbox in metres, the unit itself where it is in use for that size.
/// @throws InputError as metres_in().
DISMANTLE_API std::string unit_for_people(std::string_view unit, double size);

}  // namespace dismantle
