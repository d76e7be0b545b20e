/// Record of the divisions of the box of poses and the contractions of cells, from which the certificate is made.
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
  std::vector<double> points;      ///< 5 each: 1 if of `a`, else 0; index of the obstacle in the other part; x, y, z
  std::vector<double> directions;  ///< 3 each, unit vectors
  std::vector<double> box;         ///< 12: of all cells, lower and upper bounds
  std::vector<double> tree;
  std::size_t leaves = 0;
};

class DecompositionRecord {
 public:
  /// Adds the next cell. Cells are numbered as in the decomposition, in the order in which they are added.
  void add(Contraction made) { nodes_.push_back({std::move(made), -1, 0, 0}); }
  /// Divides a cell across a coordinate. Its halves are the next two cells.
  void divide(std::uint32_t cell, int axis, double at, Contraction below, Contraction above);
  /// Grows the box beyond `at` by the next cell.
  void grow(int axis, bool upper, double at, Contraction slab);

  /// The proof for the box with those bounds. The solids of `a` come first among the obstacles of the pair.
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
