// Stand-ins for the built-in types: they do nothing, but declare parameters of every kind.
#include <limits>

#include "dismantle/plugin.h"

namespace {

using namespace dismantle;  // NOLINT: a file of its own

class NoSimulator : public Simulator {
 public:
  Capabilities capabilities() const noexcept override { return {}; }
  std::shared_ptr<const PreparedAssembly> prepare(const Assembly&, double, RunContext&) override { return nullptr; }
  std::unique_ptr<World> world(const Assembly&, const PreparedAssembly&, const Scene&, MotionSpace) const override {
    return nullptr;
  }
};

class NoPath : public FunctionPathPlanner {
 public:
  PathPlannerTraits traits() const noexcept override { return {}; }
  PathResult plan(const PathQuery&, RunContext&) override { return {}; }
};

class NoSequence : public SequencePlanner {
 public:
  SequenceResult plan(const SequenceQuery&, PathOracle&, SequenceObserver&, RunContext&) override { return {}; }
};

class NoTransfer : public TransferPlanner {
 public:
  Capabilities needs() const noexcept override { return {}; }
  PathResult plan(const TransferQuery&, RunContext&) override { return {}; }
};

struct SimulatorParameters {
  double contact_stiffness = 1e6;
  double time_step = 1e-3;
  static void describe(Schema<SimulatorParameters>& s) {
    s.add("contact_stiffness", &SimulatorParameters::contact_stiffness,
          {.unit = "1/s^2", .min = 0, .min_open = true, .doc = "Stiffness of contact."});
    s.add("time_step", &SimulatorParameters::time_step,
          {.unit = "s", .min = 0, .max = 1, .min_open = true, .doc = "Length of one time step."});
  }
};

enum class Motion { translation, rotation, automatic };

struct BfsParameters {
  Motion motion = Motion::automatic;
  double similarity_translation = 0.05;
  double lean = 0.5;
  Motion last = Motion::rotation;
  static void describe(Schema<BfsParameters>& s) {
    s.add_choice<Motion>("motion", &BfsParameters::motion,
                         {{"translation", Motion::translation, "Six actions."},
                          {"rotation", Motion::rotation, "Twelve actions."},
                          {"auto", Motion::automatic, "Translation first."}},
                         "Which motions are tried.");
    s.add("similarity_translation", &BfsParameters::similarity_translation,
          {.unit = "assembly units", .min = 0, .doc = "States closer than this are the same."});
    s.advanced("lean", &BfsParameters::lean, {0, 1});
    s.advanced("last", &BfsParameters::last, {{"translation", Motion::translation}, {"rotation", Motion::rotation}});
  }
};

struct TRrtParameters {
  double goal_bias = 0.05;
  double range = 0.5;
  std::int64_t max_nodes = 10000;
  bool greedy = false;
  std::string note = "none";
  float weight = 1;
  static void describe(Schema<TRrtParameters>& s) {
    s.add("goal_bias", &TRrtParameters::goal_bias,
          {.unit = "1", .min = 0, .max = 1, .doc = "Probability of drawing the goal."});
    s.add("range", &TRrtParameters::range,
          {.unit = "assembly units", .min = 0, .min_open = true, .doc = "Longest extension."});
    s.add("max_nodes", &TRrtParameters::max_nodes, {.unit = "1", .min = 1, .max = 1e15, .doc = "Size of the tree."});
    s.add("greedy", &TRrtParameters::greedy, {.doc = "Extend as far as it goes."});
    s.add("note", &TRrtParameters::note, {.doc = "Free text | with a bar."});
    s.add("weight", &TRrtParameters::weight, {.unit = "1", .doc = "Any number."});
  }
};

class NoProof final : public ImmobilityProver {
 public:
  ProverTraits traits() const noexcept override { return {}; }
  std::optional<Certificate> prove(const SeparationQuery&, const RunContext&) const override { return std::nullopt; }
};

struct RingParameters {
  std::int64_t max_rings = 2;
  unsigned heights = 24;
  static void describe(Schema<RingParameters>& s) {
    s.advanced("heights", &RingParameters::heights, {1});
    s.add("max_rings", &RingParameters::max_rings, {.unit = "1", .min = 1, .doc = "Rings tried."});
  }
};

class NoJudgement final : public StepCheck {
 public:
  StepCheckTraits traits() const noexcept override { return {}; }
  StepVerdict judge(const StepQuestion&, const RunContext&) const override { return {}; }
};

struct GravityParameters {
  std::int64_t hands = 1;
  static void describe(Schema<GravityParameters>& s) {
    s.add("hands", &GravityParameters::hands, {.unit = "1", .min = 0, .doc = "Hands that hold parts."});
  }
};

struct RandomParameters {
  std::int64_t attempts = 3;
  static void describe(Schema<RandomParameters>& s) {
    s.add("attempts", &RandomParameters::attempts, {.unit = "1", .min = 1, .doc = "Attempts per part."});
  }
};

struct Child {
  PluginRef<PathPlanner> plugin;
  std::int64_t after = 0;
  double share = 1;
  static void describe(Schema<Child>& s) {
    s.advanced("share", &Child::share, {0, 1});
    s.add("after", &Child::after, {.unit = "1", .min = 0, .doc = "Steps before it begins."});
  }
};

struct TeamParameters {
  std::vector<Child> of;
  PluginRef<PathPlanner> last{"bfs"};
  bool fair = true;
  PluginRef<PathPlanner> judge{"t_rrt"};
  static void describe(Schema<TeamParameters>& s) {
    s.advanced("judge", &TeamParameters::judge);
    s.add("of", &TeamParameters::of, {.doc = "Who takes part."});
    s.add("last", &TeamParameters::last, {.doc = "Who comes last."});
    s.add("fair", &TeamParameters::fair, {.doc = "All alike."});
  }
};

/// Makes what it holds, as a planner with children does.
class Team : public NoPath {
 public:
  explicit Team(const TeamParameters& params) : last_(params.last.create()) {
    for (const Child& child : params.of) children_.push_back(child.plugin.create());
  }

 private:
  std::shared_ptr<PathPlanner> last_;
  std::vector<std::shared_ptr<PathPlanner>> children_;
};

struct AfterParameters {
  std::int64_t after = 1;
  static void describe(Schema<AfterParameters>& s) {
    s.add("after", &AfterParameters::after, {.unit = "1", .doc = "The same name as an option of Child."});
  }
};

}  // namespace

DISMANTLE_PLUGIN("dismantle.fixture", "0.1.0", "MIT", "https://example.org") {
  const Capabilities all{.dynamics = true, .contacts = true, .distance = true, .max_moving = 8};
  r.add<Simulator, NoSimulator, SimulatorParameters>("sdf_penalty", "Penalty contact.", {.provides = all});
  r.add<Simulator, NoSimulator>("geometry_only", "No dynamics.", {.provides = {.distance = true}});
  r.add<PathPlanner, NoPath, BfsParameters>("bfs", "Breadth first.",
                                            {.source = "Algorithm 1", .needs = {.dynamics = true}});
  r.add<PathPlanner, NoPath, BfsParameters>("guided", "Breadth first, with proposals.", {.needs = {.dynamics = true}});
  r.add<PathPlanner, NoPath, TRrtParameters>("t_rrt", "Targetless RRT.", {.needs = {.distance = true}});
  r.add<PathPlanner, NoPath>("pairs", "Moves two parts.", {.needs = {.distance = true, .max_moving = 2}});
  r.add<PathPlanner, Team, TeamParameters>("team", "Holds others.");
  r.add<PathPlanner, NoPath, AfterParameters>("clash", "Cannot be held by a team.");
  r.add<SequencePlanner, NoSequence>("blocking", "By who is in whose way.");
  r.add<SequencePlanner, NoSequence>("progressive", "Deepens by and by.", {.source = "Algorithm 2"});
  r.add<SequencePlanner, NoSequence, RandomParameters>("random", "Any order.");
  r.add<TransferPlanner, NoTransfer>("rrt_connect", "Two trees.");
  r.add<ImmobilityProver, NoProof>("overlap_lock", "A point in both.");
  r.add<ImmobilityProver, NoProof, RingParameters>("ring", "A ring in a chamber.");
  r.add<StepCheck, NoJudgement>("directions", "Changes of direction.");
  r.add<StepCheck, NoJudgement, GravityParameters>("sagging", "Does it stand?");
}
