#include "gravity.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <utility>

#include "dismantle/part_set.h"
#include "dismantle/statics/describe.h"
#include "dismantle/statics/step_proof.h"

namespace dismantle::checks {

namespace {

using Json = nlohmann::ordered_json;
using Vec3 = Eigen::Vector3d;
using statics::Gaps;
using statics::joined;

constexpr double kSameUp = 1e-9;    // 1 - cosine
constexpr double kFixtureHand = 2;  // what a hand that is not there costs more

std::string quoted(const Assembly& assembly, PartId part) { return "'" + assembly.parts[part].name + "'"; }

std::string list_of(const Assembly& assembly, const std::vector<PartId>& parts) {
  std::vector<std::string> names;
  for (const PartId p : parts) names.push_back(quoted(assembly, p));
  return fmt::format("{}", fmt::join(names, ", "));
}

/// Adds parts with their poses to a key: a pose only where it is not that of the part before.
void add_key(std::span<const PlacedPart> parts, std::vector<double>& key) {
  constexpr double kPoseFollows = -1;  // no id
  Pose last;
  for (const PlacedPart& p : parts) {
    if (!(p.pose == last))
      key.insert(key.end(), {kPoseFollows, p.pose.t.x(), p.pose.t.y(), p.pose.t.z(), p.pose.q.w(), p.pose.q.x(),
                             p.pose.q.y(), p.pose.q.z()});
    key.push_back(static_cast<double>(p.part));
    last = p.pose;
  }
}

/// To three significant digits, for readers.
double rounded(double value) {
  if (!(value > 0)) return 0;
  const double unit = std::pow(10, std::floor(std::log10(value)) - 2);
  return std::stod(fmt::format("{:.3g}", std::round(value / unit) * unit));
}

}  // namespace

void GravityParameters::describe(Schema<GravityParameters>& s) {
  s.add("fixed", &GravityParameters::fixed,
        {.doc = "Parts that a fixture holds all the time: names or patterns with * and ?, with commas between them."});
  s.add("hands", &GravityParameters::hands,
        {.unit = "1",
         .min = 1,
         .max = 100,
         .doc = "Hands that there are, the one with the part that is put in included. A step that needs more is not "
                "allowed, and the plan asks for a fixture."});
  s.add("friction", &GravityParameters::friction,
        {.unit = "1", .min = 0, .max = 10, .doc = "Coefficient of Coulomb friction of all contacts."});
  s.add("density", &GravityParameters::density,
        {.doc = "Densities in g/cm3 as NAME=VALUE with commas between them; names as in `fixed`. Other parts have that "
                "of their file, or 1."});
  s.advanced("most_parts", &GravityParameters::most_parts, {1, 100000});
}

Gravity::Gravity(const GravityParameters& params)
    : params_(params), model_(params.fixed, params.friction, params.density) {}

std::shared_ptr<Gravity::Scene> Gravity::scene_of(const Assembly& assembly) const {
  const std::lock_guard lock(mutex_);
  if (scene_ && scene_->piles->is_of(assembly)) return scene_;
  scene_ = std::make_shared<Scene>();
  scene_->piles = std::make_unique<const statics::BuiltPiles>(assembly, model_.options(assembly));
  return scene_;
}

/// How the bodies fall that somebody must hold, each as if all others did not move by themselves, and the forces on
/// what is held. The sum of motions that all contacts allow is one, too.
std::string Gravity::picture_of(const statics::Holds& holds, const statics::BuiltPile& built,
                                std::span<const PlacedPart> parts, const Assembly& assembly) {
  const statics::Pile& pile = built.pile;
  statics::Motions all(pile.bodies.size());
  for (const statics::HoldGroup& group : holds.groups) {
    double most = 0;
    for (std::size_t i = 0; i < group.motion.size(); ++i)
      most = std::max(most, group.motion[i].v.norm() + group.motion[i].w.norm() * pile.bodies[i].radius);
    for (std::size_t i = 0; i < group.motion.size() && most > 0; ++i) {
      all[i].v += group.motion[i].v / most;
      all[i].w += group.motion[i].w / most;
    }
  }
  const Normalization& to = assembly.normalization;
  statics::PictureFrame frame;
  frame.place = [&](const Vec3& p) { return to.to_input(p); };
  frame.scale = 1 / to.scale;
  frame.names = [&](std::uint32_t body) {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < parts.size(); ++i)
      if (built.body_of[i] == body) names.push_back(assembly.parts[parts[i].part].name);
    return names;
  };
  return statics::picture_json(pile, all, holds.forces, holds.held, holds.held, frame);
}

Gravity::State Gravity::holds_of(Scene& scene, const statics::BuiltPile& built, std::span<const PlacedPart> parts,
                                 const Assembly& assembly) const {
  const statics::Holds holds = statics::least_holds_by_forces(built.pile, {}, &scene.judgements);
  State state;
  state.found = holds.found;
  state.proved = holds.proved;
  state.displacement = holds.displacement;
  if (holds.found && holds.proved) {
    statics::HoldProof proof{holds.held, holds.displacement, {}};
    for (const statics::HoldGroup& group : holds.groups) proof.falls.push_back(group.motion);
    statics::add_hold_proof(proof, built.pile, "", state.numbers);
  }
  if (holds.held.empty()) return state;
  const statics::ContactForces& forces = holds.forces;
  const std::vector<statics::Contact>& contacts = built.pile.contacts;
  for (const std::uint32_t body : holds.held) {
    Hold hold;
    double largest = -1;
    for (std::size_t i = 0; i < parts.size(); ++i)  // the largest of the parts that are one body
      if (const double v = assembly.parts[parts[i].part].volume; built.body_of[i] == body && v > largest) {
        largest = v;
        hold.part = parts[i].part;
      }
    Vec3 force = built.pile.bodies[body].weight * built.pile.down;
    for (std::size_t k = 0; k < forces.size(); ++k)
      for (const Vec3& f : forces[k])
        force += contacts[k].a == body ? f : contacts[k].b == body ? Vec3(-f) : Vec3(Vec3::Zero());
    hold.newton = force.norm();
    for (const statics::HoldGroup& group : holds.groups) {
      if (group.motion.empty()) continue;
      const statics::Motion& motion = group.motion[body];
      if (!(motion.v.norm() + motion.w.norm() > 0)) continue;
      hold.motion = statics::motion_text(built.pile.bodies[body], motion, built.pile.down);
      hold.why = statics::missing_text(built.pile, body, group.motion);
      break;
    }
    state.holds.push_back(std::move(hold));
  }
  state.picture = picture_of(holds, built, parts, assembly);
  return state;
}

Gravity::StatePtr Gravity::at_rest(Scene& scene, const Assembly& assembly, std::span<const PlacedPart> placed,
                                   const Vec3& up, bool table, const RunContext& context) const {
  const std::vector<PlacedPart> parts = statics::where_assembled({placed.begin(), placed.end()});
  std::vector<double> key{up.x(), up.y(), up.z(), table ? 1.0 : 0.0};
  add_key(parts, key);
  return kept(scene.at_rest, std::move(key), context, [&] {
    State state;
    const auto balanced = [&](Gaps gaps) {
      const statics::Pile pile = scene.piles->pile(parts, up, gaps, table).pile;
      statics::Judgement found = statics::judge_forces(pile);
      if (found.verdict != statics::Verdict::stands || !statics::hanging_groups(pile).empty()) return false;
      state.gaps = gaps;
      state.displacement = found.displacement;
      statics::add_hold_proof({{}, std::move(found.displacement), {}}, pile, "", state.numbers);
      return true;
    };
    if (!table || scene.piles->unsupported(parts, parts, up) > 0 || !(balanced(Gaps::tight) || balanced(Gaps::play)))
      state = holds_of(scene, scene.piles->pile(parts, up, Gaps::play, table), parts, assembly);
    return std::make_shared<const State>(std::move(state));
  });
}

/// What the present parts need while the new one is pressed in, and while it is pulled back a little.
Gravity::StatePtr Gravity::while_put_in(Scene& scene, const StepQuestion& question, const RunContext& context) const {
  if (question.present.empty() || question.direction.isZero()) return std::make_shared<const State>();
  const std::vector<PlacedPart> present = joined(question.present, {});
  const Vec3 &up = question.up, &along = question.direction;
  std::vector<double> key{up.x(), up.y(), up.z(), along.x(), along.y(), along.z()};
  add_key(question.moving, key);
  key.push_back(-2);  // neither an id nor the mark of a pose
  add_key(present, key);
  return kept(scene.while_put_in, std::move(key), context,
              [&] { return pressed_and_pulled(scene, question, present, context); });
}

/// What holds them at rest is taken first: usually it is enough. The forces of rest are near those of a small push.
Gravity::StatePtr Gravity::pressed_and_pulled(Scene& scene, const StepQuestion& question,
                                              const std::vector<PlacedPart>& parts, const RunContext& context) const {
  const StatePtr rest = at_rest(scene, question.assembly, parts, question.up, true, context);
  StatePtr worst = rest;
  const statics::BuiltPile alone = scene.piles->pile(parts, question.up, Gaps::play);
  const bool same_bodies = rest->displacement.size() == alone.pile.bodies.size();
  for (const double sign : {1.0, -1.0}) {
    statics::BuiltPile pressed = alone;
    scene.piles->press(pressed, parts, question.moving, sign * question.direction, statics::kHandPush, Gaps::play);
    if (pressed.pile.pushes.empty()) continue;
    statics::Pile held = pressed.pile;
    for (const Hold& h : rest->holds)
      for (std::size_t i = 0; i < parts.size(); ++i)
        if (parts[i].part == h.part) held.bodies[pressed.body_of[i]].fixed = true;
    const statics::Motions near = same_bodies ? rest->displacement : statics::Motions();
    if (statics::judge_forces(held, {}, near).verdict == statics::Verdict::stands) continue;
    State state = holds_of(scene, pressed, parts, question.assembly);
    state.push = sign * statics::kHandPush;
    if (state.holds.size() > worst->holds.size() || !state.found)
      worst = std::make_shared<const State>(std::move(state));
  }
  return worst;
}

std::optional<Certificate> Gravity::proof_of(std::span<const PlacedPart> parts, const State& after, const State& during,
                                             const State& turned, double gap) {
  Certificate proof{"gravity", {}, {}, false, gap, {}, "The parts that are held suffice, and no fewer do."};
  for (const PlacedPart& p : parts) proof.parts.push_back(p.part);
  const auto add = [&](const char* name, const State& state) {
    if (state.numbers.empty()) return;
    for (const auto& [what, numbers] : state.numbers) proof.numbers[name + what] = numbers;
    proof.numbers[std::string(name) + ".gaps"] = {state.gaps == Gaps::tight ? 0.0 : 1.0};
  };
  add("after", after);
  add("during", during);
  if (!during.numbers.empty()) proof.numbers["during.push"] = {during.push};
  add("turning", turned);
  if (proof.parts.size() < 2 || proof.numbers.empty() || !(gap > 0)) return std::nullopt;
  return proof;
}

StepVerdict Gravity::estimate(const StepQuestion& question, const RunContext& /*context*/) const {
  StepVerdict verdict;
  if (question.moving.empty()) return verdict;
  const std::vector<PlacedPart> all = joined(question.present, question.moving);
  const bool large = all.size() > static_cast<std::size_t>(params_.most_parts);
  const std::span<const PlacedPart> of = large ? question.moving : std::span<const PlacedPart>(all);
  const std::size_t count = scene_of(question.assembly)->piles->unsupported(all, of, question.up);
  if (count == 0) return verdict;
  verdict.cost = static_cast<double>(count);
  verdict.reason = fmt::format("nothing is under {} part{}", count, count == 1 ? "" : "s");
  return verdict;
}

StepVerdict Gravity::judge(const StepQuestion& question, const RunContext& context) const {
  const Assembly& assembly = question.assembly;
  const std::vector<PlacedPart> all = joined(question.present, question.moving);
  if (all.size() > static_cast<std::size_t>(params_.most_parts)) return estimate(question, context);
  const std::shared_ptr<Scene> scene = scene_of(assembly);
  const StatePtr at_rest_after = at_rest(*scene, assembly, all, question.up, true, context);
  const StatePtr put_in = while_put_in(*scene, question, context);
  StatePtr while_turned = std::make_shared<const State>();
  if (question.previous != nullptr && !question.present.empty() && question.previous->up.dot(question.up) < 1 - kSameUp)
    while_turned = at_rest(*scene, assembly, joined(question.present, {}),
                           statics::up_while_turned(question.previous->up, question.up), false, context);
  const State &after = *at_rest_after, &during = *put_in, &turned = *while_turned;
  StepVerdict verdict;
  verdict.certificate = proof_of(all, after, during, turned, scene->piles->gap(after.gaps));
  std::set<PartId> held;
  Json holds = Json::array();
  const auto add = [&](const State& state, const char* when) {
    for (const Hold& h : state.holds) {
      held.insert(h.part);
      holds.push_back({{"part", assembly.parts[h.part].name}, {"when", when}, {"newton", rounded(h.newton)}});
      if (!h.motion.empty()) holds.back()["motion"] = h.motion;
      if (!h.why.empty()) holds.back()["why"] = h.why;
    }
  };
  add(after, "after");
  add(during, "during");
  // To turn the whole, one hand holds it anyway.
  const std::size_t turning = turned.holds.empty() ? 0 : turned.holds.size() - 1;
  if (turning > 0) add(turned, "turning");
  verdict.cost = static_cast<double>(held.size());
  const bool unclear = !after.found || !during.found || !turned.found;
  const std::size_t hands = std::max({after.holds.size(), 1 + during.holds.size(), 1 + turning});
  const bool too_many = unclear || hands > static_cast<std::size_t>(params_.hands);
  // A fixture costs more than a hand that is there: rather three steps with one more hold each than one with three.
  if (hands > static_cast<std::size_t>(params_.hands))
    verdict.cost += kFixtureHand * static_cast<double>(hands - static_cast<std::size_t>(params_.hands));
  if (holds.empty() && !unclear) return verdict;
  std::vector<std::string> texts;
  for (const Hold& h : after.holds)
    texts.push_back(h.motion.empty() ? fmt::format("Hold {}.", quoted(assembly, h.part))
                                     : fmt::format("Hold {}: it {} otherwise{}{}.", quoted(assembly, h.part), h.motion,
                                                   h.why.empty() ? "" : ", since ", h.why));
  std::vector<PartId> only_during;
  for (const Hold& h : during.holds)
    if (std::none_of(after.holds.begin(), after.holds.end(), [&](const Hold& a) { return a.part == h.part; }))
      only_during.push_back(h.part);
  if (!only_during.empty())
    texts.push_back(fmt::format("Hold {} while {} is put in.", list_of(assembly, only_during),
                                list_of(assembly, ids_of(question.moving))));
  if (turning > 0) texts.push_back("Hold the parts together while the assembly is turned.");
  if (too_many)
    texts.push_back(unclear ? "No set of holds was found with which it stands: use a fixture."
                            : fmt::format("This takes {} hands: use a fixture.", hands));
  verdict.allowed = !too_many;
  verdict.reason = unclear ? "no set of holds was found with which it stands"
                           : fmt::format("{} part{} must be held", held.size(), held.size() == 1 ? "" : "s");
  Json data = {{"hold", holds}, {"hands", hands}, {"proved", after.proved && during.proved && turned.proved}};
  // Of one state: the assembly with the new part, or without it.
  if (const State& drawn = after.holds.empty() ? during : after; !drawn.picture.empty()) {
    data["picture"] = Json::parse(drawn.picture);
    data["picture"]["when"] = after.holds.empty() ? "during" : "after";
  }
  verdict.notes.push_back(
      {"hold", fmt::format("{}", fmt::join(texts, " ")), data.dump(-1, ' ', false, Json::error_handler_t::replace)});
  return verdict;
}

/// A lower bound of the hands of any order. Searches ask about many orders of the same units, which have the same one.
std::shared_ptr<const statics::HandsBound> Gravity::bound_of(std::span<const StepQuestion> operations) const {
  const std::shared_ptr<Scene> scene = scene_of(operations.front().assembly);
  std::set<std::vector<double>> key;  // units and orientations
  const auto add = [&](std::span<const PlacedPart> unit, const Vec3& up) {
    std::vector<double> parts;
    for (const PlacedPart& p : joined(unit, {})) parts.push_back(static_cast<double>(p.part));
    key.insert(std::move(parts));
    key.insert({-1, up.x(), up.y(), up.z()});
  };
  add(operations.front().present, operations.front().up);
  for (const StepQuestion& q : operations) add(q.moving, q.up);
  {
    const std::lock_guard lock(mutex_);
    if (scene->bound && scene->bound_of == key) return scene->bound;
  }
  auto bound = std::make_shared<const statics::HandsBound>(statics::least_hands(*scene->piles, operations));
  const std::lock_guard lock(mutex_);
  scene->bound_of = std::move(key);
  return scene->bound = std::move(bound);
}

StepVerdict Gravity::judge_plan(std::span<const StepQuestion> operations, const RunContext& /*context*/) const {
  StepVerdict verdict;
  if (operations.empty()) return verdict;
  const Assembly& assembly = operations.front().assembly;
  const auto large = std::count_if(operations.begin(), operations.end(), [&](const StepQuestion& q) {
    return q.moving.size() + q.present.size() > static_cast<std::size_t>(params_.most_parts);
  });
  if (large > 0) {
    verdict.notes.push_back(
        {"gravity.not_checked",
         fmt::format("In {} of {} steps more than {} parts are there: only the part that is put in was judged, on "
                     "others that do not move.",
                     large, operations.size(), params_.most_parts)});
    return verdict;
  }
  const std::shared_ptr<const statics::HandsBound> bound = bound_of(operations);
  if (bound->hands < 2) return verdict;
  std::vector<std::string> names;
  for (const PartId p : bound->loose) names.push_back(assembly.parts[p].name);
  verdict.notes.push_back(
      {"gravity.hands",
       fmt::format(
           "Any order of these steps, with the table where it is in the end, takes {} hands or more: each of {} "
           "parts, such as {}, falls even if the other {} are there and held.",
           bound->hands, names.size(), quoted(assembly, bound->loose.front()), bound->others),
       Json{{"hands_at_least", bound->hands}, {"loose", names}}.dump(-1, ' ', false, Json::error_handler_t::replace)});
  const double gap = scene_of(assembly)->piles->gap(Gaps::play);
  verdict.certificate = {"gravity", {}, {}, false, gap, bound->numbers, "Any order takes two hands in some step."};
  for (const PlacedPart& p : joined(operations.back().present, operations.back().moving))
    verdict.certificate->parts.push_back(p.part);
  return verdict;
}

}  // namespace dismantle::checks
