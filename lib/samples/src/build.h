/// Shared by the sample makers: parameter declarations and helpers for models.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>

#include "dismantle/samples/samples.h"
#include "solids.h"

namespace dismantle::samples {

/// A sample and how to make it from complete parameters, before `rotate_seed` is applied.
struct Maker {
  Sample sample;
  std::function<Model(const ParamSet&)> make;
};

struct SampleFacts {
  bool solvable = true;
  bool translation_only = true;
  bool one_at_a_time = true;
  bool clean = true;
};

template <class Parameters>
Maker maker(std::string name, std::string summary, Model (*build)(const Parameters&), SampleFacts facts = {}) {
  const Schema<Parameters> schema;
  Maker m;
  m.sample = {std::move(name), std::move(summary),     schema.specs(),     facts.solvable,
              facts.clean,     facts.translation_only, facts.one_at_a_time};
  m.make = [schema, build](const ParamSet& values) { return build(schema.bind(values)); };
  return m;
}

// The makers, one function per source file.
std::vector<Maker> fit_makers();        // fits.cpp: pegs, sleeves, washers
std::vector<Maker> slot_makers();       // slots.cpp: slots and boxes
std::vector<Maker> turning_makers();    // turning.cpp: threads and rings
std::vector<Maker> leg_makers();        // legs.cpp: furniture with threaded legs
std::vector<Maker> interlock_makers();  // interlock.cpp
std::vector<Maker> machine_makers();    // machine.cpp
std::vector<Maker> pressed_makers();  // pressed.cpp: pins, screws and seals with overlap around the whole circumference
std::vector<Maker> flexible_makers();  // flexible.cpp: clips, springs, gears
std::vector<Maker> pile_makers();      // piles.cpp: blocks that touch, with known statics
std::vector<Maker> doubled_makers();   // doubled.cpp: two solids that fill the same space

/// Adds a part after checking that it is a solid. Returns its name.
std::string add_part(Model& model, std::string name, Mesh mesh);

/// A straight slide of one part; `out`: the part is then separated.
TruthStep slide(const std::string& part, const Point& displacement, bool out);

/// The translation of slide() as a screw.
Screw along(const Point& travel);

/// Adds `clearance` with the doc that all samples share.
template <class Parameters>
void add_clearance(Schema<Parameters>& s, double min, double max) {
  s.add("clearance", &Parameters::clearance,
        {.unit = "mm", .min = min, .max = max, .doc = "Smallest distance between any two parts when assembled."});
}

template <class Parameters>
void add_segments(Schema<Parameters>& s) {
  s.add("segments", &Parameters::segments,
        {.unit = "1", .min = 8, .max = 512, .doc = "Number of flat faces per full turn of a round surface."});
}

}  // namespace dismantle::samples
