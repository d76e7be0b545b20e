#include "ndbg/ndbg.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <vector>

#include "blocking_graph/strategies/free_group.h"
#include "blocking_graph/strategies/free_part.h"
#include "blocking_graph/strategies/search_rounds.h"
#include "blocking_graph/strategy_list.h"
#include "ndbg/arrangement.h"

namespace dismantle {

void NdbgParameters::describe(Schema<NdbgParameters>& s) {
  s.add_choice("order", &NdbgParameters::order, part_orders(),
               "Order in which parts are removed when several are free.");
  s.add("circles", &NdbgParameters::circles,
        {.unit = "1",
         .min = 0,
         .max = 24,
         .doc = "Largest number of great circles in the arrangement: those of the flat faces with the most surface "
                "area. The number of cells, and so the time, grows with the square. 0 = only the axes of the parts."});
  s.add_choice("cells", &NdbgParameters::cells,
               {{"vertices", NdbgCells::vertices, "where two circles cross: along two flat contacts"},
                {"arcs", NdbgCells::arcs, "and the arcs between: along one contact"},
                {"faces", NdbgCells::faces, "and the faces: away from all contacts"}},
               "Cells of the arrangement that are examined.");
  s.add("groups", &NdbgParameters::groups,
        {.doc = "When no single part is free, remove the smallest free subassembly and disassemble it separately."});
  s.advanced("group_proposals", &NdbgParameters::group_proposals, {1});
  s.add("searches", &NdbgParameters::searches,
        {.doc = "When no translation removes anything, run the path planner for each part, one level deeper in every "
                "round. Off: blocking graphs alone."});
  s.add("max_depth", &NdbgParameters::max_depth,
        {.unit = "1", .min = 0, .max = 1e6, .doc = "Largest depth of the searches; 0 = no limit."});
}

namespace ndbg {

blocking::Directions directions_of(const Assembly& assembly, unsigned circles, NdbgCells cells) {
  blocking::Directions directions = blocking::directions_of(assembly);
  const std::size_t axes = directions.all.size();
  const auto add = [&](const std::vector<Eigen::Vector3d>& list) {
    for (const Eigen::Vector3d& d : list) {
      if (std::any_of(directions.all.begin(), directions.all.end(), [&](const Eigen::Vector3d& known) {
            return std::abs(known.dot(d)) > 1 - 1e-6;
          }))  // the limit for axes of faces
        continue;
      directions.all.push_back(d);
      directions.all.push_back(-d);
    }
  };
  const Arrangement arrangement =
      arrangement_of(circles > 0 ? circle_normals(assembly, circles) : std::vector<Eigen::Vector3d>{});
  add(arrangement.vertices);
  if (cells != NdbgCells::vertices) add(arrangement.arcs);
  if (cells == NdbgCells::faces) add(arrangement.faces);
  std::vector<std::size_t> added(directions.all.size() - axes);
  std::iota(added.begin(), added.end(), axes);
  directions.common.insert(directions.common.end(), added.begin(), added.end());
  for (auto& of_part : directions.of_part) of_part.insert(of_part.end(), added.begin(), added.end());
  return directions;
}

}  // namespace ndbg

SequenceResult Ndbg::plan(const SequenceQuery& query, PathOracle& oracle, SequenceObserver& observer,
                          RunContext& context) {
  using namespace blocking;
  const Assembly& assembly = query.assembly;
  DisassemblyState state(query, overlap_locks(query, oracle, context), params_.order, observer, context);
  StrategyList list(state, oracle);
  std::unique_ptr<PairSweep> sweep;
  std::unique_ptr<StraightMotion> straight;
  if (oracle.tolerance() > 0) {
    sweep = std::make_unique<PairSweep>(assembly, oracle);
    straight = std::make_unique<StraightMotion>(state, oracle, *sweep,
                                                ndbg::directions_of(assembly, params_.circles, params_.cells));
    state.add_listener(*straight);
    list.add(std::make_unique<FreePart>(state, *straight));
    if (params_.groups) list.add(std::make_unique<FreeGroup>(state, *straight, params_.group_proposals));
  }
  // An oracle without geometry allows no sweeps, so only searches are left.
  if (params_.searches || !straight)
    list.add(std::make_unique<SearchRounds>(state, oracle, SearchRounds::Settings{.max_depth = params_.max_depth}));
  SequenceResult result = list.run();
  if (straight) {
    result.counts["directions"] = static_cast<double>(straight->directions().all.size());
    result.counts["relations"] = static_cast<double>(straight->computed());
  }
  return result;
}

}  // namespace dismantle
