#include "configuration_cells/decomposition_record.h"

#include <map>
#include <utility>

#include "dismantle/immobility/free_space_bound.h"

namespace dismantle::immobility {
namespace {

using Vec3 = Eigen::Vector3d;

// Entries of the list `tree`, see the README.
enum Entry { kLeaf, kCut, kRound, kMove };

}  // namespace

void DecompositionRecord::divide(std::uint32_t cell, int axis, double at, Contraction below, Contraction above) {
  nodes_[cell].axis = axis;
  nodes_[cell].at = at;
  nodes_[cell].below = static_cast<std::uint32_t>(nodes_.size());
  add(std::move(below));
  add(std::move(above));
}

void DecompositionRecord::grow(int axis, bool upper, double at, Contraction slab) {
  slabs_.push_back({static_cast<std::uint32_t>(nodes_.size()), axis, upper, at});
  add(std::move(slab));
}

class DecompositionRecord::Writer {
 public:
  Writer(const DecompositionRecord& record, const SampledPair& pair, std::uint32_t solids_of_a)
      : record_(record), pair_(pair), solids_of_a_(solids_of_a) {}

  DecompositionProof write() {
    // Cuts off the slabs in reverse order of their addition; the first cell remains.
    std::vector<std::uint32_t> above;
    for (auto slab = record_.slabs_.rbegin(); slab != record_.slabs_.rend(); ++slab) {
      cut(slab->axis, slab->at);
      if (slab->upper)
        above.push_back(slab->cell);
      else
        write_below(slab->cell);
    }
    write_below(0);
    for (auto cell = above.rbegin(); cell != above.rend(); ++cell) write_below(*cell);
    return std::move(proof_);
  }

 private:
  void add(double x) { proof_.tree.push_back(x); }
  void cut(int axis, double at) {
    add(kCut);
    add(axis);
    add(at);
  }

  void write_below(std::uint32_t root) {
    std::vector<std::uint32_t> stack{root};
    while (!stack.empty()) {
      const Node& node = record_.nodes_[stack.back()];
      stack.pop_back();
      for (const std::vector<FaceMove>& round : node.made) {
        if (round.empty()) continue;
        add(kRound);
        for (const FaceMove& move : round) write(move);
      }
      if (node.axis < 0) {
        add(kLeaf);
        ++proof_.leaves;
        continue;
      }
      cut(node.axis, node.at);
      stack.push_back(node.below + 1);
      stack.push_back(node.below);
    }
  }

  void write(const FaceMove& move) {
    add(kMove);
    add(move.face);
    if (move.face != FaceMove::kEmpty) add(move.to);
    add(static_cast<double>(move.reasons.size()));
    for (const Reason& r : move.reasons) {
      add(static_cast<double>(point_of(r.sample)));
      add(static_cast<double>(direction_of(pair_.samples()[r.sample].obstacle, r.source)));
      add(r.multiplier);
    }
  }

  /// Index of the sample in the list of points; adds it if it is new.
  std::size_t point_of(std::uint32_t number) {
    const auto [known, fresh] = points_.try_emplace(number, points_.size());
    if (fresh) {
      const InteriorSample& sample = pair_.samples()[number];
      const Vec3 at = sample.at + pair_.center();
      proof_.points.insert(
          proof_.points.end(),
          {sample.of_a ? 1.0 : 0.0, static_cast<double>(sample.of_a ? sample.obstacle - solids_of_a_ : sample.obstacle),
           at.x(), at.y(), at.z()});
    }
    return known->second;
  }

  std::size_t direction_of(std::uint32_t obstacle, std::uint32_t source) {
    const auto [known, fresh] = directions_.try_emplace({obstacle, source}, directions_.size());
    if (fresh) {
      const Solid& solid = *pair_.obstacle(obstacle).solid;
      const Vec3 d = solid.frame.q * half_space_normal(solid, source);
      proof_.directions.insert(proof_.directions.end(), {d.x(), d.y(), d.z()});
    }
    return known->second;
  }

  const DecompositionRecord& record_;
  const SampledPair& pair_;
  std::uint32_t solids_of_a_;
  std::map<std::uint32_t, std::size_t> points_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> directions_;
  DecompositionProof proof_;
};

DecompositionProof DecompositionRecord::proof(const SampledPair& pair, std::uint32_t solids_of_a, const Vector6& lo,
                                              const Vector6& hi) const {
  DecompositionProof proof = Writer(*this, pair, solids_of_a).write();
  proof.box.assign(lo.data(), lo.data() + 6);
  proof.box.insert(proof.box.end(), hi.data(), hi.data() + 6);
  return proof;
}

}  // namespace dismantle::immobility
