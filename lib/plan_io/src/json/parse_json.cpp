#include "json/parse_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <set>
#include <vector>

#include "dismantle/errors.h"
#include "dismantle/plan_io/plan_file.h"

namespace dismantle {

namespace {

using Json = nlohmann::ordered_json;

/// Iterates over a text, and tells where the parser is.
class Reading {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  Reading(const char* at, const char*& reached) : at_(at), reached_(&reached) {}
  reference operator*() const { return *at_; }
  Reading& operator++() {
    *reached_ = ++at_;
    return *this;
  }
  bool operator==(const Reading& other) const { return at_ == other.at_; }

 private:
  const char* at_;
  const char** reached_;
};

/// An object that is being read.
struct Level {
  std::set<std::string> keys{};
  std::string last{};         ///< the newest of the keys
  const char* end = nullptr;  ///< of that key in the text
};

}  // namespace

nlohmann::ordered_json parse_json(const std::string& text, const std::string& source) {
  using Event = Json::parse_event_t;
  std::vector<Level> levels;
  const char* reached = text.data();
  const auto watch = [&](int, Event event, Json& parsed) {
    if (event == Event::object_start) levels.emplace_back();
    if (event == Event::object_end) {
      levels.pop_back();
      const std::size_t n = levels.size();
      if (n > 1 && levels[n - 1].last == "data" && levels[n - 2].last == "notes")
        parsed = Json::binary({std::find(levels[n - 1].end, reached, '{'), reached});
    }
    if (event == Event::key) {
      Level& level = levels.back();
      level.last = parsed.get<std::string>();
      level.end = reached;
      if (!level.keys.insert(level.last).second)
        throw InputError(source, fmt::format("the key '{}' stands twice in one object", level.last));
    }
    return true;
  };
  try {
    return Json::parse(Reading(text.data(), reached), Reading(text.data() + text.size(), reached), watch);
  } catch (const Json::exception& e) {
    std::string what = e.what();  // "[json.exception.parse_error.101] parse error at line 3, column 7: ..."
    if (const auto end = what.find("] "); end != std::string::npos) what.erase(0, end + 2);
    throw InputError(source, "not valid JSON: " + what);
  }
}

bool is_json_object(const std::string& text) {
  try {
    return parse_json(text, "").is_object();
  } catch (const InputError&) {
    return false;
  }
}

}  // namespace dismantle
