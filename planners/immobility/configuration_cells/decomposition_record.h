/// How the box of poses was divided and the cells were contracted: what a certificate is made of.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "configuration_cells/contraction.h"
#include "dismantle/immobility/interior_samples.h"

namespace dismantle::immobility {

/// Lists of numbers of a certificate; see the README for their order. Lengths and places are in assembly units.
struct DecompositionProof {
  std::vector<double> points;  ///< 5 each: is it of `a`; the obstacle's place among the solids of the other; x, y, z
  std::vector<double> directions;  ///< 3 each, unit vectors
  std::vector<double> box;         ///< 12: of all cells, lower and upper bounds
  std::vector<double> tree;
  std::size_t leaves = 0;
};

class DecompositionRecord {
 public:
  /// The next cell. Cells have the numbers that they have in the decomposition, by the order in which they are added.
  void add(Contraction made) { nodes_.push_back({std::move(made), -1, 0, 0}); }
  /// The cell is divided across a coordinate. Its halves are the next two.
  void divide(std::uint32_t cell, int axis, double at, Contraction below, Contraction above);
  /// The box has grown beyond `at`, by the cell that comes next.
  void grow(int axis, bool upper, double at, Contraction slab);

  /// Of the box with those bounds. The solids of `a` come first among the obstacles of the pair.
  DecompositionProof proof(const SampledPair& pair, std::uint32_t solids_of_a, const Vector6& lo,
                           const Vector6& hi) const;

 private:
  struct Node {
    Contraction made;
    int axis;  ///< < 0: not divided
    double at;
    std::uint32_t below;
  };
  struct Slab {
    std::uint32_t cell;
    int axis;
    bool upper;
    double at;
  };
  class Writer;

  std::vector<Node> nodes_;
  std::vector<Slab> slabs_;
};

}  // namespace dismantle::immobility
