// Databases of results: read for reports, and taken up again by a campaign.
#include "dismantle/bench/report.h"
#include "dismantle/errors.h"
#include "expect.h"
#include "input_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace dismantle;
  const auto file = fuzz::input_file("results.db", {data, size});
  const auto plans = fuzz::scratch_folder() / "out" / "plans";
  try {
    const bench::ReportData all = bench::read_results({file});
    const auto tables = bench::tables_of(all);
    bench::report_text(all, tables);
    bench::report_markdown(all, tables);
    bench::report_html(all, tables);
    bench::report_csv(tables);
    bench::write_plans(all, plans);
    for (const auto& row : all.rows) bench::write_row(row, fuzz::scratch_folder() / "out" / "row");
  } catch (const Error&) {
  }
  std::filesystem::remove_all(fuzz::scratch_folder() / "out");
  // Nothing may be written beside the folders that were named.
  for (const auto& entry : std::filesystem::directory_iterator(fuzz::scratch_folder()))
    FUZZ_EXPECT(entry.path().filename().string().starts_with("results.db"));
  return 0;
}
