#include "trial/files.h"

#include <fmt/format.h>

#include <fstream>
#include <sstream>

#include "dismantle/errors.h"
#include "dismantle/plan.h"
#include "dismantle/plan_io/write_file.h"

namespace dismantle::bench {

std::string read_text(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  if (in.peek() != std::ifstream::traits_type::eof()) text << in.rdbuf();
  if (!in.is_open() || in.bad()) throw Error(fmt::format("{}: cannot be read", file.string()));
  return text.str();
}

nlohmann::json read_json(const std::filesystem::path& file) {
  try {
    return nlohmann::json::parse(read_text(file));
  } catch (const nlohmann::json::exception& e) {
    throw InputError(file.string(), e.what());
  }
}

void write_request(const TrialRequest& r, const std::filesystem::path& folder) {
  nlohmann::json values = nlohmann::json::object();
  for (const auto& [name, value] : r.sample_values)
    std::visit(
        [&, key = name](const auto& v) {
          using V = std::decay_t<decltype(v)>;
          if constexpr (std::is_same_v<V, PluginChoice> || std::is_same_v<V, std::vector<PluginChoice>>)
            throw std::logic_error("samples hold no plugins: " + key);
          else
            values[key] = v;
        },
        value);
  const nlohmann::json json = {{"config", r.config.string()},
                               {"input", r.input.string()},
                               {"sample", r.sample},
                               {"sample_values", values},
                               {"rotate", r.rotate},
                               {"seed", r.seed},
                               {"part", r.part},
                               {"inputs", r.inputs.string()},
                               {"input_name", r.input_name},
                               {"max_penetration", r.max_penetration}};
  write_file(TrialFiles(folder).request, json.dump(1) + "\n");
}

TrialRequest read_request(const std::filesystem::path& folder) {
  const nlohmann::json json = read_json(TrialFiles(folder).request);
  TrialRequest r;
  try {
    r.config = json.at("config").get<std::string>();
    r.input = json.at("input").get<std::string>();
    r.sample = json.at("sample").get<std::string>();
    for (const auto& [name, value] : json.at("sample_values").items()) {
      if (value.is_boolean())
        r.sample_values[name] = value.get<bool>();
      else if (value.is_number_integer())
        r.sample_values[name] = value.get<std::int64_t>();
      else if (value.is_number())
        r.sample_values[name] = value.get<double>();
      else
        r.sample_values[name] = value.get<std::string>();
    }
    r.rotate = json.at("rotate").get<bool>();
    r.seed = json.at("seed").get<std::int64_t>();
    r.part = json.at("part").get<std::string>();
    r.inputs = json.at("inputs").get<std::string>();
    r.input_name = json.at("input_name").get<std::string>();
    r.max_penetration = json.at("max_penetration").get<double>();
  } catch (const nlohmann::json::exception& e) {
    throw InputError(TrialFiles(folder).request.string(), e.what());
  }
  return r;
}

}  // namespace dismantle::bench
