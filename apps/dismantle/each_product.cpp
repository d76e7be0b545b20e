#include "each_product.h"

#include <fmt/format.h>
#include <signal.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>

#include "command.h"
#include "dismantle/errors.h"
#include "dismantle/plan_io/csv_text.h"
#include "dismantle/plan_io/text_columns.h"
#include "dismantle/plan_io/write_file.h"
#include "dismantle/process/child.h"
#include "dismantle/session/products.h"
#include "interrupt.h"
#include "settings.h"

namespace dismantle::app {
namespace {

namespace fs = std::filesystem;

/// A row of the summary.
struct Row {
  std::string name, input, plan;
  std::string status = "not begun";  // that of the JSON line of `plan`
  std::optional<int> exit_status{};
  std::optional<std::int64_t> parts{}, steps{}, forced{};
  double seconds = 0;
  bool kept = false;
  std::string message{};
};

std::string last_line(const std::string& text) {
  const std::size_t end = text.find_last_not_of('\n');
  if (end == std::string::npos) return "";
  const std::size_t before = text.rfind('\n', end);
  const std::size_t begin = before == std::string::npos ? 0 : before + 1;
  return text.substr(begin, end + 1 - begin);
}

/// `dismantle plan` on one product.
class Running {
 public:
  Running(const EachProduct& each, std::size_t place, const Row& row, const fs::path& folder) : place_(place) {
    process::Program program{.command = {fs::read_symlink("/proc/self/exe").string(), "plan", row.input}};
    program.command.insert(program.command.end(), each.options.begin(), each.options.end());
    program.command.insert(program.command.end(), {"-o", folder.string(), "--keep-finished", "--format", "json", "-q"});
    program.whole_tree = true;
    program.output = [this](std::span<const std::byte> bytes) {
      output_.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
      return true;
    };
    child_.emplace(program);
  }
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  std::size_t place() const { return place_; }
  process::Child& child() { return *child_; }

  /// What it left, once it has ended.
  void fill(Row& row) const {
    const process::End& end = child_->end();
    row.exit_status = end.signal == 0 ? end.status : 128 + end.signal;
    row.seconds = end.wall_seconds;
    row.status = "error";
    const auto json = nlohmann::json::parse(last_line(output_), nullptr, false);
    if (json.is_object()) {
      const auto number = [&](const char* key) {
        return json.contains(key) ? std::optional(json[key].get<std::int64_t>()) : std::nullopt;
      };
      row.status = json.value("status", row.status);
      row.message = json.value("message", "");
      row.kept = json.value("kept", false);
      row.seconds = json.value("planned_seconds", row.seconds);
      row.parts = number("parts");
      row.steps = number("steps");
      row.forced = number("forced");
      if (json.contains("plan") && json["plan"].is_string()) row.plan = json["plan"].get<std::string>();
    } else {
      row.message = end.signal != 0 ? fmt::format("ended by signal {}", end.signal) : last_line(end.last_words);
    }
  }

 private:
  std::size_t place_;
  std::string output_;
  std::optional<process::Child> child_;
};

std::string cell(const std::optional<std::int64_t>& number) { return number ? std::to_string(*number) : ""; }

std::string complete_word(const Row& row) {
  return !row.exit_status ? "" : *row.exit_status == kComplete ? "yes" : "no";
}

std::string exit_cell(const Row& row) { return row.exit_status ? std::to_string(*row.exit_status) : ""; }

std::string csv_of(const std::vector<Row>& rows) {
  std::string out = "name,input,status,complete,parts,steps,forced,seconds,exit_status,kept,plan,message\n";
  for (const Row& row : rows)
    out += fmt::format("{},{},{},{},{},{},{},{:.3f},{},{},{},{}\n", csv_field(row.name), csv_field(row.input),
                       row.status, complete_word(row), cell(row.parts), cell(row.steps), cell(row.forced), row.seconds,
                       exit_cell(row), row.kept ? "yes" : "no", csv_field(row.plan), csv_field(row.message));
  return out;
}

/// The same for a terminal.
std::string table_of(const std::vector<Row>& rows) {
  std::size_t width = 7;
  for (const Row& row : rows) width = text::column_of(width, row.name);
  std::string out = text::padded("product", width) + "  parts  result       forced      time  exit\n";
  for (const Row& row : rows) {
    out += fmt::format("{}  {:>5}  {:11}  {:>6}  {:>6.1f} s  {:>4}", text::padded(row.name, width), cell(row.parts),
                       row.status, cell(row.forced), row.seconds, exit_cell(row));
    if (row.kept) out += "  kept from an earlier run";
    if (!row.message.empty()) out += "  " + row.message;
    out += "\n";
  }
  return out;
}

class EachRun {
 public:
  EachRun(const EachProduct& each, const Products& found, Console& console, RunContext& context)
      : each_(each), console_(console), context_(context), output_(each.output) {
    for (const Product& product : found.products) {
      Row& row = rows_.emplace_back();
      row.name = product.name;
      row.input = product.input.string();
    }
  }

  const std::vector<Row>& run() {
    while (true) {
      while (running_.size() < each_.jobs && next_ < rows_.size() && !context_.cancel.cancelled()) start();
      if (running_.empty()) break;
      std::vector<const process::Child*> children;
      for (const auto& one : running_) children.push_back(&one->child());
      process::Child::wait(children);
      if (context_.cancel.cancelled() && !told_) {
        for (const auto& one : running_) one->child().signal(SIGINT);  // they save what is done
        told_ = true;
      }
      take_ended();
    }
    write_summary();
    return rows_;
  }

 private:
  void start() {
    const Row& row = rows_[next_];
    running_.push_back(std::make_unique<Running>(each_, next_, row, output_ / row.name));
    ++next_;
    show();
  }

  void take_ended() {
    for (std::size_t i = 0; i < running_.size();) {
      if (!running_[i]->child().ended()) {
        ++i;
        continue;
      }
      Row& row = rows_[running_[i]->place()];
      running_[i]->fill(row);
      running_.erase(running_.begin() + static_cast<std::ptrdiff_t>(i));
      ++done_;
      write_summary();
      console_.line(fmt::format("{}/{} {}: {}{}{}", done_, rows_.size(), row.name, row.status,
                                row.kept ? ", kept from an earlier run" : "",
                                row.message.empty() ? "" : ": " + row.message));
      show();
    }
  }

  void show() {
    std::vector<std::string> names;
    for (const auto& one : running_) names.push_back(rows_[one->place()].name);
    context_.progress("products", done_, rows_.size(), text::joined(names));
  }

  void write_summary() const { write_file(output_ / "summary.csv", csv_of(rows_)); }

  const EachProduct& each_;
  Console& console_;
  RunContext& context_;
  const fs::path output_;
  std::vector<Row> rows_;
  std::vector<std::unique_ptr<Running>> running_;
  std::size_t next_ = 0, done_ = 0;
  bool told_ = false;
};

}  // namespace

int plan_each(const EachProduct& each, const Session& session, Console& console) {
  RunContext context;
  console.attach(context);
  cancel_on_signals(context.cancel);
  const Products found = products_in(each.folder, session);
  for (const std::string& aside : found.left_aside) console.warning("no product: " + aside);
  open_output_folder(each.output);
  const std::vector<Row> rows = EachRun(each, found, console, context).run();
  console.end_progress();
  const auto complete = static_cast<std::size_t>(
      std::ranges::count_if(rows, [](const Row& row) { return row.exit_status == kComplete; }));
  const auto kept = static_cast<std::size_t>(std::ranges::count_if(rows, &Row::kept));
  const bool interrupted = context.cancel.cancelled() && complete < rows.size();
  const std::string summary = (fs::path(each.output) / "summary.csv").string();
  std::string text = table_of(rows);
  text += fmt::format("{} of {} complete", complete, text::counted(rows.size(), "product"));
  if (kept > 0) text += fmt::format(", {} kept from an earlier run", kept);
  text += interrupted ? "\ninterrupted: the same command goes on\n" : "\n";
  console.text(text + fmt::format("wrote {}\n", summary));
  const int status = interrupted ? kInterrupted : complete == rows.size() ? kComplete : kPartial;
  console.result({{"status", interrupted           ? "interrupted"
                             : status == kComplete ? "complete"
                                                   : "partial"},
                  {"products", rows.size()},
                  {"complete", complete},
                  {"kept", kept},
                  {"summary", summary}});
  return status;
}

}  // namespace dismantle::app
