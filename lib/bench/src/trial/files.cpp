#include "trial/files.h"

#include <fmt/format.h>

#include "dismantle/errors.h"
#include "dismantle/plan.h"
#include "dismantle/plan_io/read_file.h"
#include "dismantle/plan_io/write_file.h"

/// Values of the parameters of samples.
template <>
struct nlohmann::adl_serializer<dismantle::ParamValue> {
  static void to_json(json& out, const dismantle::ParamValue& value) {
    std::visit(
        [&](const auto& v) {
          if constexpr (std::is_arithmetic_v<std::decay_t<decltype(v)>> ||
                        std::is_same_v<std::decay_t<decltype(v)>, std::string>)
            out = v;
          else
            throw std::logic_error("samples hold no plugins");
        },
        value);
  }
  static void from_json(const json& in, dismantle::ParamValue& value) {
    if (in.is_boolean())
      value = in.get<bool>();
    else if (in.is_number_integer())
      value = in.get<std::int64_t>();
    else if (in.is_number())
      value = in.get<double>();
    else
      value = in.get<std::string>();
  }
};

namespace dismantle::bench {

nlohmann::json read_json(const std::filesystem::path& file) {
  try {
    return nlohmann::json::parse(read_file(file));
  } catch (const nlohmann::json::exception& e) {
    throw InputError(file.string(), e.what());
  }
}

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(TrialRequest, config, input, sample, sample_values, rotate, seed, part, inputs,
                                   input_name, max_penetration, plugins, search_nodes)

void write_request(const TrialRequest& request, const std::filesystem::path& folder) {
  write_file(TrialFiles(folder).request, nlohmann::json(request).dump(1) + "\n");
}

TrialRequest read_request(const std::filesystem::path& folder) {
  const nlohmann::json json = read_json(TrialFiles(folder).request);
  try {
    return json.get<TrialRequest>();
  } catch (const nlohmann::json::exception& e) {
    throw InputError(TrialFiles(folder).request.string(), e.what());
  }
}

void write_result(const TrialResult& result, const std::filesystem::path& folder) {
  nlohmann::ordered_json json;
  for_result_columns(result, [&]<class T>(const char* name, const T& value, const char*) {
    if constexpr (requires { *value; }) {
      if (value) json[name] = *value;
    } else if (value != T{}) {
      json[name] = value;
    }
  });
  write_file(TrialFiles(folder).result, json.dump(1) + "\n");
}

void read_result(const std::filesystem::path& folder, TrialResult& result) {
  const nlohmann::json json = read_json(TrialFiles(folder).result);
  json.at("outcome");  // there is one, whatever else the process could say
  for_result_columns(result, [&]<class T>(const char* name, T& value, const char*) {
    if (!json.contains(name)) return;
    if constexpr (requires { *value; })
      json.at(name).get_to(value.emplace());
    else
      json.at(name).get_to(value);
  });
}

}  // namespace dismantle::bench
