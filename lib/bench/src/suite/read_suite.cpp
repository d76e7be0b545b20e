#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <set>

#include "dismantle/bench/suite.h"
#include "dismantle/host/config_bind.h"
#include "dismantle/host/suggest.h"
#include "dismantle/plan_io/read_file.h"
#include "suite/assemblies.h"
#include "suite/problem.h"
#include "suite/search_paths.h"
#include "suite/seeds.h"
#include "suite/tables.h"

namespace dismantle::bench {
namespace {

namespace fs = std::filesystem;

/// `rotate:` of a variant.
enum class Rotate { none, random };

struct VariantValues {
  Rotate rotate = Rotate::none;
  std::string part;
  static void describe(Schema<VariantValues>& s) {
    s.add_choice("rotate", &VariantValues::rotate,
                 {{"none", Rotate::none, "As it stands in the files."},
                  {"random", Rotate::random, "The whole assembly turned by a rotation drawn from the trial's seed."}},
                 "How the assembly is turned.");
    s.add("part", &VariantValues::part, {.doc = "Plan only this part; all others are fixed."});
  }
};

struct VerifyValues {
  double max_penetration = VerifyOptions{}.max_penetration;
  double cpu = Suite{}.verify_cpu;
  static void describe(Schema<VerifyValues>& s) {
    s.add("max_penetration", &VerifyValues::max_penetration,
          {.unit = "assembly units",
           .min = 0,
           .min_open = true,
           .doc = "Largest penetration that a plan may have beyond the pair's overlap when assembled."});
    s.add("cpu", &VerifyValues::cpu,
          {.unit = "s",
           .min = 1,
           .doc = "CPU time after which the verifying process is killed; twice that of wall-clock time."});
  }
};

/// A value of `set:`, written as YAML again.
std::string yaml_of(const ConfigNode& node) {
  if (node.kind == ConfigNode::Kind::sequence) {
    std::string items;
    for (const auto& item : node.items) items += (items.empty() ? "" : ", ") + yaml_of(item);
    return "[" + items + "]";
  }
  if (!node.quoted) return node.scalar;
  std::string out = "'";
  for (const char c : node.scalar) out += c == '\'' ? std::string("''") : std::string(1, c);
  return out + "'";
}

class Reader {
 public:
  explicit Reader(const fs::path& file) { suite_.file = file; }

  Suite read() {
    ConfigNode root;
    std::string unreadable;
    if (!read_yaml(suite_.file.string(), root, problems_, unreadable))
      throw ConfigError({Diagnostic{"", 0, 0, unreadable}});
    if (!root.is_map()) {
      problems_.push_back(root.mark.error(fmt::format("a suite must be a map of keys, not {}", root.kind_name())));
      throw ConfigError(problems_);
    }
    suite_.text = read_file(suite_.file);
    take_schema(root, problems_);
    root_ = &root;
    check_keys();
    read_name();
    suite_.limits = section<Limits>("limits");
    const auto verify = section<VerifyValues>("verify");
    suite_.max_penetration = verify.max_penetration;
    suite_.verify_cpu = verify.cpu;
    check_limits();
    const ConfigNode* seeds = node("seeds");
    suite_.seeds = seeds == nullptr ? std::vector<std::int64_t>{1} : read_seeds(*seeds, "", problems_);
    if (const ConfigNode* plugins = node("plugins"))
      search_paths_ = read_search_paths(*plugins, suite_.file.parent_path(), problems_);
    if (const ConfigNode* list = required("assemblies")) read_assemblies(*list, suite_, problems_);
    try {
      problem_ = problem_of(root, suite_.max_penetration);
    } catch (const ConfigError& e) {
      problems_.insert(problems_.end(), e.diagnostics().begin(), e.diagnostics().end());
    }
    if (const ConfigNode* map = required("planners")) read_planners(*map);
    read_variants();
    if (!problems_.empty()) {
      sort_by_place(problems_);
      throw ConfigError(std::move(problems_));
    }
    return std::move(suite_);
  }

 private:
  const ConfigNode* node(const char* key) const {
    const auto* member = root_->find(key);
    return member == nullptr ? nullptr : &member->value;
  }
  const ConfigNode* required(const char* key) {
    const ConfigNode* found = node(key);
    if (found == nullptr) problems_.push_back(root_->mark.error(fmt::format("missing key '{}'", key)));
    return found;
  }

  void check_keys() {
    std::vector<std::string> known = {"schema", "name",   "assemblies",     "planners", "seeds",
                                      "limits", "verify", "assembly_steps", "variants"};
    known.insert(known.end(), kForAll.begin(), kForAll.end());
    known.insert(known.end(), {"objective", "plugins", "tables", "search_nodes"});
    for (const auto& member : root_->members)
      if (std::find(known.begin(), known.end(), member.key) == known.end())
        problems_.push_back(member.key_mark.error(unknown_key_message(member.key, {"", "", ""}, known, {})));
  }

  void read_name() {
    suite_.name = suite_.file.stem().string();
    struct Top {
      std::string name;
      bool assembly_steps = false;
      std::int64_t search_nodes = 0;
      static void describe(Schema<Top>& s) {
        s.add("name", &Top::name, {.doc = "Title of the reports; default: the file's name."});
        s.add("assembly_steps", &Top::assembly_steps, {.doc = "Plan the assembly steps, too."});
        s.add("search_nodes", &Top::search_nodes,
              {.unit = "1", .min = 0, .max = 1e6, .doc = "Nodes of search trees that each trial keeps."});
      }
    };
    ConfigNode plain;
    plain.kind = ConfigNode::Kind::map;
    for (const char* key : {"name", "assembly_steps", "search_nodes"})
      if (const auto* member = root_->find(key)) plain.members.push_back(*member);
    std::map<std::string, std::string> origins;
    const Top top =
        Schema<Top>().bind(bind_section(Schema<Top>().specs(), &plain, {"suite", "", ""}, {}, origins, problems_));
    if (!top.name.empty()) suite_.name = top.name;
    assembly_steps_ = top.assembly_steps;
    suite_.search_nodes = top.search_nodes;
    if (const ConfigNode* list = node("tables")) suite_.tables = read_tables(*list, problems_);
  }

  template <class T>
  T section(const char* name) {
    std::map<std::string, std::string> origins;
    return Schema<T>().bind(bind_section(Schema<T>().specs(), node(name), {name, "", ""}, {}, origins, problems_));
  }

  void check_limits() {
    if (suite_.limits.timeout > 0 || suite_.limits.wall > 0) return;
    const ConfigNode* limits = node("limits");
    problems_.push_back((limits != nullptr ? limits : root_)
                            ->mark.error("limits.timeout is 0, so limits.wall must be given: a trial that hangs has to "
                                         "end some time"));
  }

  void read_planners(const ConfigNode& map) {
    if (!map.is_map() || map.members.empty()) {
      problems_.push_back(map.mark.error("planners must be a map from names to configurations"));
      return;
    }
    for (const auto& member : map.members) read_planner(member);
  }

  void read_planner(const ConfigMember& member) {
    const std::string label = "planners." + member.key;
    if (!member.value.is_map() && member.value.kind != ConfigNode::Kind::null) {
      problems_.push_back(member.value.mark.error(fmt::format(
          "{} must be a map with the keys config, set and seeds, not {}", label, member.value.kind_name())));
      return;
    }
    ConfigSource source;
    std::vector<ConfigMark> places;
    std::vector<std::int64_t> seeds = suite_.seeds;
    const auto fail = [&](const ConfigMark& mark, const std::string& what) {
      problems_.push_back(mark.error(fmt::format("{}: {}", label, what)));
    };
    for (const auto& [key, key_mark, value] : member.value.members) {
      if (key == "config" && value.is_scalar() && !value.scalar.empty()) {
        source.file = (suite_.file.parent_path() / value.scalar).lexically_normal();
      } else if (key == "set" && value.is_map()) {
        for (const auto& item : value.members) {
          if (is_for_all(item.key)) {
            fail(item.key_mark, belongs_to_the_suite(item.key.substr(0, item.key.find('.'))));
            continue;
          }
          if (item.value.is_map()) {
            fail(item.value.mark, "keys of set are written with dots, as in path_planner.goal_bias: 0.1");
            continue;
          }
          source.set.push_back(item.key + "=" + yaml_of(item.value));
          places.push_back(item.value.mark);
        }
      } else if (key == "seeds") {
        seeds = read_seeds(value, label + ": ", problems_);
      } else if (key == "config" || key == "set") {
        fail(value.mark, fmt::format("{} must be {}, not {}", key, key == "set" ? "a map" : "the name of a file",
                                     value.kind_name()));
      } else {
        problems_.push_back(key_mark.error(unknown_key_message(key, {label, "", ""}, {"config", "set", "seeds"}, {})));
      }
    }
    // Planners are compared by what they find, not by how an objective likes it, unless the suite names one.
    const bool own_objective =
        std::ranges::any_of(source.set, [](const std::string& s) { return s.starts_with("objective"); });
    if (!own_objective) {
      source.set.emplace_back("objective=[]");
      places.push_back(member.key_mark);
    }
    SuitePlanner planner;
    planner.name = member.key;
    planner.seeds = std::move(seeds);
    load_planner(std::move(planner), source, places, member.key_mark, own_objective);
  }

  void load_planner(SuitePlanner planner, ConfigSource source, const std::vector<ConfigMark>& places,
                    const ConfigMark& name_mark, bool own_objective) {
    const Limits& l = suite_.limits;
    const auto option = [&](const char* flag, const char* key, const ParamValue& value) {
      source.options.push_back({flag, key, to_text(value)});
    };
    option("limits.path_timeout", "run.path_timeout", l.path_timeout);
    option("limits.path_steps", "run.path_steps", l.path_steps);
    option("limits.timeout", "run.timeout", l.timeout);
    option("limits.threads", "run.threads", static_cast<std::int64_t>(l.threads));
    option("seeds", "run.seed", std::int64_t{1});
    option("assembly_steps", "layout.enabled", assembly_steps_);
    const std::string name = planner.name;
    const auto load = [&] {
      planner.registry = std::make_shared<Registry>();
      for (const auto& path : search_paths_) planner.registry->add_search_path(path);
      planner.config = load_config(source, *planner.registry);
      auto& paths = planner.config.plugin_search_paths;
      paths.insert(paths.end(), search_paths_.begin(), search_paths_.end());
    };
    try {
      load();
      if (auto refusal = own_section(planner)) {
        problems_.push_back(*std::move(refusal));
        return;
      }
      give_problem(problem_, planner, source, suite_.notes);
      for (const auto section : kForAll)
        if (const auto* member = root_->find(std::string(section))) source.sections.push_back(*member);
      if (const auto* member = root_->find("objective"); member != nullptr && !own_objective)
        source.sections.push_back(*member);
      load();
    } catch (const ConfigError& e) {
      for (Diagnostic d : e.diagnostics()) {
        // Errors in `set` refer to this file. Errors without a place refer to the planner's entry.
        const auto at = static_cast<std::size_t>(d.line) - 1;
        const ConfigMark* mark = d.file == "<--set>" && d.line > 0 && at < places.size() ? &places[at]
                                 : d.file.empty() || d.file.starts_with('<')             ? &name_mark
                                                                                         : nullptr;
        if (mark != nullptr) d = mark->error(fmt::format("planners.{}: {}", name, d.message));
        // What is wrong with a section of the suite is found with each planner.
        const auto same = [&](const Diagnostic& known) { return known.text() == d.text(); };
        if (std::ranges::none_of(problems_, same)) problems_.push_back(std::move(d));
      }
      return;
    }
    for (const auto& warning : planner.config.warnings)
      suite_.notes.push_back(fmt::format("planners.{}: {}", name, warning));
    suite_.planners.push_back(std::move(planner));
  }

  void read_variants() {
    const ConfigNode* map = node("variants");
    if (map == nullptr) {
      suite_.variants.emplace_back().name = "plain";
      return;
    }
    if (!map->is_map() || map->members.empty()) {
      problems_.push_back(map->mark.error("variants must be a map from names to variants, such as plain: {}"));
      return;
    }
    for (const auto& member : map->members) {
      SuiteVariant variant;
      variant.name = member.key;
      ConfigNode plain = member.value;
      if (const auto* planners = member.value.find("planners")) {
        read_names(planners->value, "variants." + member.key, variant.planners);
        plain.erase("planners");
      }
      std::map<std::string, std::string> origins;
      const auto values = Schema<VariantValues>().bind(bind_section(Schema<VariantValues>().specs(), &plain,
                                                                    {"variants." + member.key, "", ""},
                                                                    {{"planners", {"a variant"}}}, origins, problems_));
      variant.rotate = values.rotate == Rotate::random;
      variant.part = values.part;
      suite_.variants.push_back(std::move(variant));
    }
  }

  void read_names(const ConfigNode& list, const std::string& label, std::vector<std::string>& out) {
    std::vector<std::string> known;
    if (const ConfigNode* planners = node("planners"))
      for (const auto& member : planners->members) known.push_back(member.key);
    if (list.kind != ConfigNode::Kind::sequence || list.items.empty())
      problems_.push_back(list.mark.error(label + ".planners must be a list of names of planners"));
    for (const auto& item : list.items) {
      if (std::find(known.begin(), known.end(), item.scalar) == known.end()) {
        const auto near = nearest(item.scalar, known);
        problems_.push_back(item.mark.error(fmt::format("{}: there is no planner '{}'{}", label, item.scalar,
                                                        near ? fmt::format("; did you mean '{}'?", *near) : "")));
      }
      out.push_back(item.scalar);
    }
  }

  const ConfigNode* root_ = nullptr;
  std::vector<Diagnostic> problems_;
  Suite suite_;
  bool assembly_steps_ = false;
  Problem problem_;
  std::vector<fs::path> search_paths_;
};

}  // namespace

void Limits::describe(Schema<Limits>& s) {
  s.add("path_timeout", &Limits::path_timeout, {.unit = "s", .min = 0, .doc = "Time limit of one attempt; 0 = none."});
  s.add("path_steps", &Limits::path_steps,
        {.unit = "1", .min = 0, .doc = "Limit of simulated steps per attempt; 0 = none."});
  s.add("timeout", &Limits::timeout, {.unit = "s", .min = 0, .doc = "Limit of planning time per trial; 0 = none."});
  s.add("wall", &Limits::wall, {.unit = "s", .min = 0, .doc = "Time after which a trial is killed; 0 = timeout + 60."});
  s.add("cpu", &Limits::cpu,
        {.unit = "s", .min = 0, .doc = "CPU time after which a trial is killed; 0 = threads * wall."});
  s.add("memory", &Limits::memory, {.unit = "MiB", .min = 256, .doc = "Limit of a trial's address space."});
  s.add("threads", &Limits::threads, {.unit = "1", .min = 1, .max = 1024, .doc = "Number of threads of a trial."});
}

Suite read_suite(const fs::path& file) { return Reader(file).read(); }

std::vector<Cell> matrix(const Suite& suite) {
  std::vector<std::int64_t> seeds;  // of any planner
  std::set<std::int64_t> seen;
  std::vector<std::set<std::int64_t>> own;
  for (const SuitePlanner& planner : suite.planners) {
    own.emplace_back(planner.seeds.begin(), planner.seeds.end());
    std::ranges::copy_if(planner.seeds, std::back_inserter(seeds), [&](auto seed) { return seen.insert(seed).second; });
  }
  const auto takes_part = [](const SuiteVariant& variant, const std::string& planner) {
    return variant.planners.empty() || std::ranges::find(variant.planners, planner) != variant.planners.end();
  };
  std::vector<Cell> cells;
  for (std::size_t a = 0; a < suite.assemblies.size(); ++a)
    for (const std::int64_t seed : seeds)
      for (std::size_t v = 0; v < suite.variants.size(); ++v)
        for (std::size_t p = 0; p < suite.planners.size(); ++p)
          if (own[p].contains(seed) && takes_part(suite.variants[v], suite.planners[p].name))
            cells.push_back({a, v, p, seed});
  return cells;
}

std::vector<Cell> shard_of(const std::vector<Cell>& cells, unsigned index, unsigned count) {
  std::vector<Cell> out;
  for (std::size_t i = index - 1; i < cells.size(); i += count) out.push_back(cells[i]);
  return out;
}

}  // namespace dismantle::bench
