// Laws of the plan file: it round-trips, the same plan gives the same bytes, and malformed
// text gives an InputError, nothing worse.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "dismantle/errors.h"
#include "dismantle/plan.h"
#include "dismantle/plan_io/plan_file.h"
#include "dismantle/run_context.h"

namespace dismantle {
namespace {

double any_number(Rng& rng) {
  switch (rng.below(5)) {
    case 0:
      return 0;
    case 1:
      return -0.0;
    case 2:
      return std::ldexp(rng.uniform(-1, 1), static_cast<int>(rng.below(120)) - 60);
    case 3:
      return std::round(rng.uniform(-100, 100));
    default:
      return rng.uniform(-10, 10);
  }
}

Pose any_pose(Rng& rng) {
  if (rng.below(4) == 0) return {};
  Eigen::Quaterniond q(rng.normal(), rng.normal(), rng.normal(), rng.normal());
  if (rng.below(4) == 0) q.w() = 0;
  return {{any_number(rng), any_number(rng), any_number(rng)}, q.normalized()};
}

Plan any_plan(Rng& rng) {
  Plan plan;
  plan.generator_version = "0.1.0";
  auto& a = plan.assembly;
  a.source = "dossier \"é\"/\\\n";
  a.sha256 = "00ff";
  a.scale = std::abs(any_number(rng)) + 1e-9;
  a.center = {any_number(rng), any_number(rng), any_number(rng)};
  if (rng.below(5) > 0) {
    a.box.extend({any_number(rng), any_number(rng), any_number(rng)});
    a.box.extend({any_number(rng), any_number(rng), any_number(rng)});
  }
  const auto n = static_cast<unsigned>(1 + rng.below(6));
  for (unsigned i = 0; i < n; ++i) a.parts.push_back({i, "päрт " + std::to_string(i), "f.obj"});
  const auto part = [&] { return a.parts[rng.below(n)].name; };
  for (std::uint64_t k = rng.below(3); k > 0; --k) a.excluded.push_back({"x\t", "not watertight", rng.below(2) == 0});
  for (unsigned i = 1; i < n; ++i) a.overlaps.push_back({a.parts[i - 1].name, a.parts[i].name, rng.uniform()});
  if (rng.below(2)) a.repair = {rng.uniform(0, 0.01), rng.below(2) == 0, rng.uniform()};
  const auto steps = [&] {
    std::vector<PlanStep> out(rng.below(4));
    for (std::size_t i = 0; i < out.size(); ++i) {
      PlanStep& s = out[i];
      s.step = static_cast<unsigned>(i + 1);
      const std::size_t poses = 2 + rng.below(5), moves = 1 + rng.below(n);
      for (std::size_t m = 0; m < moves; ++m) {
        s.moves.push_back({a.parts[m].name, {}});
        for (std::size_t k = 0; k < poses; ++k) s.moves.back().poses.push_back(any_pose(rng));
        s.separates.push_back({a.parts[m].name});
      }
      s.max_penetration = rng.uniform();
      s.seconds = rng.uniform();
      s.planner = "bfs";
      s.depth = static_cast<unsigned>(rng.below(10));
      s.contacts = {part()};
    }
    return out;
  };
  plan.disassembly = steps();
  plan.assembly_steps = steps();
  for (auto& s : plan.assembly_steps) s.transfer = rng.below(s.moves.front().poses.size());
  plan.assembly_status = static_cast<AssemblyStatus>(rng.below(3));
  plan.assembly_message = rng.below(2) ? "no way for 'x'" : "";
  plan.status = rng.below(2) ? PlanStatus::complete : PlanStatus::partial;
  if (rng.below(3) == 0) plan.asked.part = part();
  if (rng.below(3) == 0) plan.asked.target = part();
  if (rng.below(3) == 0) plan.asked.together = {{part()}, {a.parts[0].name, a.parts[n - 1].name}};
  if (n == 1) plan.asked.together.clear();
  plan.seed = rng.next();
  plan.verified_max_penetration = rng.uniform() + 1e-6;
  plan.remaining = {part()};
  if (rng.below(2)) plan.unsolved.push_back({part(), static_cast<Outcome>(rng.below(9)), {part()}, any_pose(rng), "m"});
  if (!plan.unsolved.empty() && rng.below(2)) {
    PlanUnsolved& u = plan.unsolved[0];
    u.planner = "guided";
    u.attempts = 1 + static_cast<unsigned>(rng.below(9));
    u.seconds = rng.uniform();
    u.depth = static_cast<unsigned>(rng.below(9));
    for (auto k = rng.below(3); k > 0; --k) u.places.push_back({part(), {any_number(rng), any_number(rng), 0}});
  }
  for (std::uint64_t k = rng.below(3); k > 0 && n > 1; --k) {
    PlanCertificate c{"ring", {a.parts[0].name, a.parts[1].name}, {}, rng.below(2) == 0, rng.uniform() + 1e-6, {},
                      "why"};
    if (rng.below(2)) c.poses = {any_pose(rng), any_pose(rng)};
    c.numbers["center"] = {any_number(rng), any_number(rng), any_number(rng)};
    if (rng.below(2)) c.numbers["none"] = {};
    plan.certificates.push_back(c);
  }
  for (PlanStep& s : plan.disassembly) {
    if (n < 2) break;
    if (rng.below(3) == 0)
      s.forced = PlanForced{a.parts[0].name,
                            a.parts[1].name,
                            rng.uniform(),
                            rng.uniform(),
                            {any_number(rng), any_number(rng), any_number(rng)},
                            "stuck"};
    if (s.forced && rng.below(2) && !plan.certificates.empty())
      s.forced->certificate = rng.below(plan.certificates.size());
    if (rng.below(3) == 0)
      s.overlaps.push_back({a.parts[1].name, a.parts[0].name, rng.uniform(), rng.uniform(), rng.uniform()});
  }
  if (!plan.certificates.empty() && !plan.unsolved.empty())
    plan.unsolved[0].certificate = rng.below(plan.certificates.size());
  return plan;
}

void expect_same(const Pose& a, const Pose& b) {
  EXPECT_EQ(a.t, b.t);
  EXPECT_TRUE(a.q.coeffs() == b.q.coeffs() || a.q.coeffs() == -b.q.coeffs());
}

void expect_same(const std::vector<PlanStep>& a, const std::vector<PlanStep>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].step, b[i].step);
    EXPECT_EQ(a[i].separates, b[i].separates);
    EXPECT_EQ(a[i].max_penetration, b[i].max_penetration);
    EXPECT_EQ(a[i].seconds, b[i].seconds);
    EXPECT_EQ(a[i].planner, b[i].planner);
    EXPECT_EQ(a[i].depth, b[i].depth);
    EXPECT_EQ(a[i].contacts, b[i].contacts);
    ASSERT_EQ(a[i].moves.size(), b[i].moves.size());
    for (std::size_t m = 0; m < a[i].moves.size(); ++m) {
      EXPECT_EQ(a[i].moves[m].part, b[i].moves[m].part);
      ASSERT_EQ(a[i].moves[m].poses.size(), b[i].moves[m].poses.size());
      for (std::size_t k = 0; k < a[i].moves[m].poses.size(); ++k)
        expect_same(a[i].moves[m].poses[k], b[i].moves[m].poses[k]);
    }
  }
}

TEST(PlanIo, ReadingGivesBackWhatWasWritten) {
  Rng rng(1);
  for (int trial = 0; trial < 200; ++trial) {
    const Plan a = any_plan(rng);
    const std::string text = to_json(a);
    const Plan b = plan_from_json(text, "plan.json");
    EXPECT_EQ(to_json(b), text);
    EXPECT_EQ(a.generator_name, b.generator_name);
    EXPECT_EQ(a.generator_version, b.generator_version);
    EXPECT_EQ(a.assembly.source, b.assembly.source);
    EXPECT_EQ(a.assembly.sha256, b.assembly.sha256);
    EXPECT_EQ(a.assembly.scale, b.assembly.scale);
    EXPECT_EQ(a.assembly.center, b.assembly.center);
    EXPECT_EQ(a.assembly.box.lo, b.assembly.box.lo);
    EXPECT_EQ(a.assembly.box.hi, b.assembly.box.hi);
    EXPECT_EQ(a.assembly.repair, b.assembly.repair);
    EXPECT_EQ(a.assembly.excluded, b.assembly.excluded);
    ASSERT_EQ(a.assembly.parts.size(), b.assembly.parts.size());
    ASSERT_EQ(a.assembly.overlaps.size(), b.assembly.overlaps.size());
    for (std::size_t i = 0; i < a.assembly.parts.size(); ++i)
      EXPECT_EQ(a.assembly.parts[i].name, b.assembly.parts[i].name);
    for (std::size_t i = 0; i < a.assembly.overlaps.size(); ++i)
      EXPECT_EQ(a.assembly.overlaps[i].depth, b.assembly.overlaps[i].depth);
    EXPECT_EQ(a.asked, b.asked);
    EXPECT_EQ(a.status, b.status);
    EXPECT_EQ(a.seed, b.seed);
    EXPECT_EQ(a.verified_max_penetration, b.verified_max_penetration);
    EXPECT_EQ(a.remaining, b.remaining);
    expect_same(a.disassembly, b.disassembly);
    expect_same(a.assembly_steps, b.assembly_steps);
    for (std::size_t i = 0; i < a.assembly_steps.size(); ++i)
      EXPECT_EQ(a.assembly_steps[i].transfer, b.assembly_steps[i].transfer);
    EXPECT_EQ(a.assembly_status, b.assembly_status);
    EXPECT_EQ(a.assembly_message, b.assembly_message);
    ASSERT_EQ(a.unsolved.size(), b.unsolved.size());
    for (std::size_t i = 0; i < a.unsolved.size(); ++i) {
      EXPECT_EQ(a.unsolved[i].outcome, b.unsolved[i].outcome);
      EXPECT_EQ(a.unsolved[i].blocked_by, b.unsolved[i].blocked_by);
      expect_same(a.unsolved[i].best_pose, b.unsolved[i].best_pose);
      EXPECT_EQ(a.unsolved[i].certificate, b.unsolved[i].certificate);
      EXPECT_EQ(a.unsolved[i].planner, b.unsolved[i].planner);
      EXPECT_EQ(a.unsolved[i].attempts, b.unsolved[i].attempts);
      EXPECT_EQ(a.unsolved[i].seconds, b.unsolved[i].seconds);
      EXPECT_EQ(a.unsolved[i].depth, b.unsolved[i].depth);
      ASSERT_EQ(a.unsolved[i].places.size(), b.unsolved[i].places.size());
      for (std::size_t k = 0; k < a.unsolved[i].places.size(); ++k) {
        EXPECT_EQ(a.unsolved[i].places[k].part, b.unsolved[i].places[k].part);
        EXPECT_EQ(a.unsolved[i].places[k].at, b.unsolved[i].places[k].at);
      }
    }
    ASSERT_EQ(a.certificates.size(), b.certificates.size());
    for (std::size_t i = 0; i < a.certificates.size(); ++i) {
      EXPECT_EQ(a.certificates[i].kind, b.certificates[i].kind);
      EXPECT_EQ(a.certificates[i].parts, b.certificates[i].parts);
      EXPECT_EQ(a.certificates[i].full_tolerance, b.certificates[i].full_tolerance);
      EXPECT_EQ(a.certificates[i].margin, b.certificates[i].margin);
      EXPECT_EQ(a.certificates[i].numbers, b.certificates[i].numbers);
      EXPECT_EQ(a.certificates[i].text, b.certificates[i].text);
      ASSERT_EQ(a.certificates[i].poses.size(), b.certificates[i].poses.size());
      for (std::size_t k = 0; k < a.certificates[i].poses.size(); ++k)
        expect_same(a.certificates[i].poses[k], b.certificates[i].poses[k]);
    }
  }
}

TEST(PlanIo, PosesStayOnOneHemisphereAndStartWithPositiveW) {
  Rng rng(2);
  for (int trial = 0; trial < 100; ++trial) {
    Plan plan = any_plan(rng);
    const Plan read = plan_from_json(to_json(plan), "p");
    for (const auto& s : read.disassembly)
      for (const auto& m : s.moves) {
        EXPECT_GE(m.poses.front().q.w(), 0);
        for (std::size_t k = 1; k < m.poses.size(); ++k) EXPECT_GE(m.poses[k - 1].q.dot(m.poses[k].q), 0);
      }
  }
}

Plan small_plan() {
  Plan plan;
  plan.assembly.parts = {{0, "peg", "peg.obj"}, {1, "hole", "hole.obj"}};
  PlanStep s;
  s.step = 1;
  s.moves = {{"peg", {Pose{{-0.0, 0, -0.0}, {-1, 0, -0.0, 0}}, Pose{{0, 0, 0.1}, Eigen::Quaterniond::Identity()}}}};
  s.separates = {{"peg"}};
  plan.disassembly = {s};
  plan.remaining = {"hole"};
  return plan;
}

TEST(PlanIo, OnePoseIsOneLineAndIdentityIsWrittenPlainly) {
  const std::string text = to_json(small_plan());
  EXPECT_NE(text.find("\n            [0, 0, 0, 1, 0, 0, 0],\n            [0, 0, 0.1, 1, 0, 0, 0]\n"), std::string::npos)
      << text;
  EXPECT_NE(text.find(R"({"id": 0, "name": "peg", "file": "peg.obj"})"), std::string::npos);
  EXPECT_EQ(text.back(), '\n');
}

TEST(PlanIo, NumbersThatAreNotFiniteAreRefused) {
  Plan plan = small_plan();
  plan.disassembly[0].moves[0].poses[1].t.x() = std::nan("");
  EXPECT_THROW(to_json(plan), Error);
}

/// The plan above with `from` (which must occur) replaced by `to`.
std::string changed(const std::string& from, const std::string& to) {
  std::string text = to_json(small_plan());
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(PlanIo, PartsSayWhatScrewsFastenAsTheNotesDo) {
  Plan plan = small_plan();
  EXPECT_EQ(to_json(plan).find("fastens"), std::string::npos);
  plan.disassembly[0].checks.push_back({.type = "tool_access"});
  auto& notes = plan.disassembly[0].checks[0].notes;
  notes.push_back(
      {"tool_access.tool", "", R"({"fastens": {"screw": "peg", "clamps": ["hole"], "into": ["hole", "peg"]}})"});
  const std::string text = to_json(plan);
  EXPECT_NE(text.substr(0, text.find("disassembly")).find("\"clamps\""), std::string::npos) << text;
  EXPECT_EQ(to_json(plan_from_json(text, "plan.json")), text);  // parts that come later in the file may be named
  // Notes of another form say nothing; a name that the plan lacks is no part.
  for (const char* data : {"[]", "{}", R"({"fastens": 3})", R"({"fastens": {"screw": 1}})",
                           R"({"fastens": {"screw": "peg", "clamps": "hole", "into": ["pig"]}})"}) {
    notes[0].data = data;
    const std::string parts = to_json(plan);
    EXPECT_EQ(parts.substr(0, parts.find("\"disassembly\"")).find("fastens"), std::string::npos) << data;
  }
}

TEST(PlanIo, ProblemsNameTheFileAndThePlace) {
  const std::vector<std::array<std::string, 3>> cases = {
      {"[0, 0, 0.1, 1, 0, 0, 0]", "[0, 0, 0.1, 1, 0, 0]", "/disassembly/0/moves/0/poses/1: expected 7 numbers"},
      {"[0, 0, 0.1, 1, 0, 0, 0]", "[0, 0, \"0.1\", 1, 0, 0, 0]", "/disassembly/0/moves/0/poses/1: expected 7 numbers"},
      {"[0, 0, 0.1, 1, 0, 0, 0]", "[0, 0, 0.1, 2, 0, 0, 0]",
       "/disassembly/0/moves/0/poses/1: the quaternion has length 2"},
      {"[0, 0, 0.1, 1, 0, 0, 0]", "[0, 0, 0.1, 0, 0, 0, 0]", "the quaternion has length 0"},
      {"\"part\": \"peg\"", "\"part\": \"pig\"", "/disassembly/0/moves/0/part: there is no part 'pig'"},
      {"\"step\": 1", "\"step\": 2", "/disassembly/0/step: expected 1"},
      {"\"version\": 1", "\"version\": 2", "/version: this program reads version 1"},
      {"dismantle.plan", "dismantle.plot", "not a plan"},
      {"\"partial\"", "\"half\"", "/status: expected"},
      {"\"scale\": 1", "\"scale\": 0", "/assembly/scale: expected a number > 0"},
      {"\"scale\": 1", "\"scale\": 1e999", "not valid JSON"},
      {"\"seed\": 0", "\"seed\": -1", "/seed: expected a whole number"},
      {"\"seed\": 0", "\"sead\": 0", "'seed' is missing"},
      {"\"seed\": 0", "\"seed\": 0, \"speed\": 1", "unknown key 'speed'"},
      {"\"seed\": 0", "\"seed\": 0, \"seed\": 1", "the key 'seed' stands twice"},
      {"\"hole\", \"file\"", "\"peg\", \"file\"", "/assembly/parts/1/name: there are two parts 'peg'"},
      {"\"id\": 1", "\"id\": 7", "/assembly/parts/1/id: expected 1"},
      {"[\"hole\"]", "[\"hole\", \"hole\"]", "/remaining/1: part 'hole' stands here twice"},
      {"\"separates\": [", "\"separates\": [[], ", "/disassembly/0/separates/0: expected at least one part"},
      {"{", "[", "not valid JSON"},
      {"\"seed\": 0", "\"seed\": 0, \"certificates\": {}", "/certificates: expected an array"},
      {"\"seed\": 0",
       "\"seed\": 0, \"certificates\": [{\"kind\": \"ring\", \"parts\": [\"peg\"], \"full_tolerance\": true, "
       "\"margin\": "
       "0.01, \"numbers\": {}, \"text\": \"\"}]",
       "/certificates/0/parts: expected two parts at least"},
      {"\"seed\": 0",
       "\"seed\": 0, \"certificates\": [{\"kind\": \"ring\", \"parts\": [\"peg\", \"hole\"], \"full_tolerance\": 1, "
       "\"margin\": 0.01, \"numbers\": {}, \"text\": \"\"}]",
       "/certificates/0/full_tolerance: expected true or false"},
      {"\"seed\": 0",
       "\"seed\": 0, \"certificates\": [{\"kind\": \"ring\", \"parts\": [\"peg\", \"hole\"], \"full_tolerance\": true, "
       "\"margin\": 0.01, \"numbers\": {\"x\": [\"1\"]}, \"text\": \"\"}]",
       "/certificates/0/numbers/x/0: expected a number"},
      {"\"overlaps\": []", "\"overlaps\": [], \"repair\": {\"weld\": 0.5, \"repair\": true, \"max_hole\": 0}",
       "/assembly/repair/weld: expected a number between 0 and 0.01"},
      {"\"overlaps\": []", "\"overlaps\": [], \"repair\": {\"weld\": 0, \"repair\": 1, \"max_hole\": 0}",
       "/assembly/repair/repair: expected true or false"},
      {"\"name\": \"peg\"", "\"name\": \"peg\", \"fastens\": {\"into\": [\"hole\", \"pig\"]}",
       "/assembly/parts/0/fastens/into/1: there is no part 'pig'"},
      {"\"bbox\": null", "\"bbox\": [[1,0,0],[0,0,0]]", "/assembly/bbox: the first corner is above the second"},
  };
  for (const auto& [from, to, message] : cases) {
    try {
      plan_from_json(changed(from, to), "dir/plan.json");
      ADD_FAILURE() << "accepted: " << from << " -> " << to;
    } catch (const InputError& e) {
      EXPECT_EQ(e.subject(), "dir/plan.json");
      EXPECT_NE(std::string(e.what()).find("dir/plan.json"), std::string::npos) << e.what();
      EXPECT_NE(std::string(e.what()).find(message), std::string::npos) << e.what();
    }
  }
}

TEST(PlanIo, NoTextDoesWorseThanAnInputError) {
  Rng rng(3);
  const std::string alphabet = "{}[]\",:0123456789eE+-.tfn \\\x80\xff\n";
  int accepted = 0, refused = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    std::string text = trial % 8 == 0 ? to_json(any_plan(rng)) : to_json(small_plan());
    for (std::uint64_t k = 1 + rng.below(4); k > 0; --k) {
      const std::size_t at = rng.below(text.size());
      switch (rng.below(4)) {
        case 0:
          text[at] = alphabet[rng.below(alphabet.size())];
          break;
        case 1:
          text.erase(at, 1 + rng.below(20));
          break;
        case 2:
          text.insert(at, 1, alphabet[rng.below(alphabet.size())]);
          break;
        default:
          text.resize(at + 1);
          break;
      }
      if (text.empty()) break;
    }
    try {
      to_json(plan_from_json(text, "p"));
      ++accepted;
    } catch (const InputError&) {
      ++refused;
    }
  }
  EXPECT_GT(accepted, 0);  // else the mutations are too coarse to get past the parser
  EXPECT_GT(refused, 2000);
  EXPECT_THROW(plan_from_json(std::string(200'000, '['), "p"), InputError);
  EXPECT_THROW(plan_from_json("", "p"), InputError);
  EXPECT_THROW(plan_from_json("null", "p"), InputError);
}

}  // namespace
}  // namespace dismantle
