#include "dismantle/geometry/length_unit.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "dismantle/errors.h"

namespace dismantle {
namespace {

TEST(LengthUnit, EveryUsualNameIsKnown) {
  for (const auto& [text, name] :
       {std::pair("mm", "mm"), std::pair("MM", "mm"), std::pair("millimeter", "mm"), std::pair("Millimetres", "mm"),
        std::pair("micron", "um"), std::pair("microns", "um"), std::pair("micrometer", "um"), std::pair("metre", "m"),
        std::pair("METER", "m"), std::pair("inches", "inch"), std::pair("in", "inch"), std::pair("feet", "foot"),
        std::pair("kilometre", "km"), std::pair("mil", "mil"), std::pair("mile", "mile")})
    EXPECT_EQ(unit_named(text), name) << text;
  for (const char* text : {"", "ell", "s", "millimetre squared"}) EXPECT_EQ(unit_named(text), "") << text;
}

TEST(LengthUnit, AUnitIsFoundByItsLength) {
  for (const char* name : {"um", "mm", "cm", "dm", "m", "km", "mil", "inch", "foot", "mile"})
    EXPECT_EQ(unit_of_length(metres_in(name)), name);
  EXPECT_EQ(unit_of_length(0.7), "");
  EXPECT_EQ(unit_of_length(0), "");
  EXPECT_EQ(metres_in("micron"), metres_in("um"));
}

TEST(LengthUnit, AnUnknownUnitIsNamedWithThoseThatAreKnown) {
  try {
    metres_in("ell");
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("um, mm"), std::string::npos) << e.what();
  }
  EXPECT_THROW(metres_in(""), InputError);
}

TEST(LengthUnit, PeopleUseMillimetresForMachines) {
  EXPECT_EQ(unit_for_people("m", 0.3), "mm");
  EXPECT_EQ(unit_for_people("m", 40), "m");
  EXPECT_EQ(unit_for_people("km", 0.1), "m");
  EXPECT_EQ(unit_for_people("mm", 50000), "mm");
  EXPECT_EQ(unit_for_people("inch", 3), "inch");
  EXPECT_EQ(unit_for_people("micron", 900), "um");
}

}  // namespace
}  // namespace dismantle
