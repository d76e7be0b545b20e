// Reads databases of benchmarks and runs suites.
#include <fmt/format.h>
#include <pybind11/stl.h>

#include "bindings.h"
#include "dismantle/bench/campaign.h"
#include "dismantle/bench/report.h"
#include "dismantle/bench/suite.h"
#include "dismantle/bench/trial.h"
#include "interruptible.h"

namespace dismantle::python {
namespace {

/// The type of a column in numpy; float where a trial may have no number.
template <class T>
const char* dtype_of(const T&) {
  if constexpr (std::is_same_v<T, std::string>) return "str";
  if constexpr (std::is_same_v<T, bool>) return "bool";
  if constexpr (std::is_same_v<T, std::int64_t>) return "int64";
  return std::is_same_v<T, std::optional<bool>> ? "object" : "float";
}

/// By name of the column: type in numpy, and the values, None where a trial has none.
py::dict read_results(const std::vector<std::filesystem::path>& paths) {
  bench::ReportData data;
  {
    py::gil_scoped_release release;
    data = bench::read_results(paths);
  }
  py::dict out;
  std::vector<py::list> columns;
  const auto add = [&](const char* name, const char* dtype) {
    out[name] = py::make_tuple(dtype, columns.emplace_back());
  };
  bench::for_columns(bench::ReportRow{},
                     [&](const char* name, const auto& member, const char*) { add(name, dtype_of(member)); });
  add("progress", "object");
  std::map<std::string, py::list> named;  // a figure that a trial does not have is None
  for (const auto& row : data.rows)
    for (const auto& [name, value] : bench::named_figures(row)) named.try_emplace(name);
  for (const auto& [name, values] : named) out[name.c_str()] = py::make_tuple("float", values);
  for (const auto& row : data.rows) {
    const std::map<std::string, double> figures = bench::named_figures(row);
    for (auto& [name, values] : named) {
      const auto found = figures.find(name);
      values.append(found == figures.end() ? py::object(py::none()) : py::object(py::float_(found->second)));
    }
    auto column = columns.begin();
    bench::for_columns(row, [&](const char*, const auto& value, const char*) { (column++)->append(py::cast(value)); });
    column->append(py::cast(row.progress));
  }
  return out;
}

py::dict run_bench(const std::string& suite_file, const std::string& folder, unsigned jobs,
                   const std::vector<std::string>& only, bool replace, const std::vector<std::string>& command,
                   const py::object& on_progress) {
  const CancelToken cancel;
  std::optional<std::function<void(const ProgressEvent&)>> progress;
  if (!on_progress.is_none())
    progress = [on_progress](const ProgressEvent& event) {
      py::gil_scoped_acquire lock;
      try {
        on_progress(py::str(event.phase.data(), event.phase.size()), event.done, event.total,
                    py::str(event.detail.data(), event.detail.size()));
      } catch (py::error_already_set& error) {
        error.discard_as_unraisable("on_progress of bench()");
      }
    };
  const bench::CampaignResult result = run_interruptible(cancel, py::none(), OnInterrupt::raise, [&] {
    const bench::Suite suite = bench::read_suite(suite_file);
    RunContext context;
    context.cancel = cancel;
    context.on_log = log_to_python;
    if (progress) context.on_progress = *progress;
    for (const auto& note : suite.notes) context.log(LogLevel::warning, note);
    std::filesystem::create_directories(folder);
    bench::CampaignOptions options;
    options.folder = folder;
    options.jobs = jobs;
    options.only = only;
    options.replace = replace;
    options.plan_command = command;
    options.verify_command = command;
    options.verify_command.emplace_back("--verify");
    return bench::run_campaign(suite, options, context);
  });
  py::dict out;
  out["total"] = result.total;
  out["done"] = result.done;
  out["solved"] = result.solved;
  out["ran"] = result.ran;
  out["replaced"] = result.replaced;
  out["database"] = result.database.string();
  return out;
}

}  // namespace

void bind_results(py::module_& m) {
  m.def("_read_results", &read_results);
  m.def("_bench", &run_bench);
  m.attr("_out_of_memory") = bench::kOutOfMemory;
  m.def("_bench_trial", [](const std::string& folder, bool verify) {
    py::gil_scoped_release release;
    verify ? bench::verify_trial(folder) : bench::plan_trial(folder);
  });
}

}  // namespace dismantle::python
