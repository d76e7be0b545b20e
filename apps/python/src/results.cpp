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

/// The results as one list per column; None where a trial has no value.
py::dict read_results(const std::vector<std::filesystem::path>& paths) {
  bench::ReportData data;
  {
    py::gil_scoped_release release;
    data = bench::read_results(paths);
  }
  py::dict out;
  const auto column = [&](const char* name, auto get) {
    py::list values;
    for (const auto& row : data.rows) values.append(py::cast(get(row)));
    out[name] = values;
  };
  using Row = bench::ReportRow;
  column("assembly", [](const Row& r) { return r.assembly; });
  column("variant", [](const Row& r) { return r.variant; });
  column("planner", [](const Row& r) { return r.planner; });
  column("category", [](const Row& r) { return r.category; });
  column("part", [](const Row& r) { return r.part; });
  column("outcome", [](const Row& r) { return r.outcome; });
  column("seed", [](const Row& r) { return r.seed; });
  column("solved", [](const Row& r) { return r.solved; });
  column("verified", [](const Row& r) { return r.verified; });
  column("parts", [](const Row& r) { return r.parts; });
  column("removed", [](const Row& r) { return r.removed; });
  column("max_penetration", [](const Row& r) { return r.max_penetration; });
  column("solve_seconds", [](const Row& r) { return r.solve_seconds; });
  column("wall_seconds", [](const Row& r) { return r.wall_seconds; });
  column("cpu_seconds", [](const Row& r) { return r.cpu_seconds; });
  column("peak_rss_mb", [](const Row& r) { return r.peak_rss_mb; });
  column("limit_timeout", [](const Row& r) { return r.limit_timeout; });
  column("host", [](const Row& r) { return r.host; });
  column("version", [](const Row& r) { return r.version; });
  column("progress", [](const Row& r) { return r.progress; });
  return out;
}

py::dict run_bench(const std::string& suite_file, const std::string& folder, unsigned jobs,
                   const std::vector<std::string>& command, const py::object& on_progress) {
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
  out["database"] = result.database.string();
  return out;
}

}  // namespace

void bind_results(py::module_& m) {
  m.def("_read_results", &read_results);
  m.def("_bench", &run_bench);
  m.def("_bench_trial", [](const std::string& folder, bool verify) {
    py::gil_scoped_release release;
    verify ? bench::verify_trial(folder) : bench::plan_trial(folder);
  });
}

}  // namespace dismantle::python
