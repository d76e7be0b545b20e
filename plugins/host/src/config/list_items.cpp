#include "config/list_items.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "dismantle/host/suggest.h"

namespace dismantle {

std::optional<std::size_t> item_index(const std::string& key, const std::vector<std::string>& types) {
  std::size_t index = 0;
  const char* end = key.data() + key.size();
  const auto read = std::from_chars(key.data(), end, index);
  if (read.ec == std::errc{} && read.ptr == end)
    return index < types.size() ? std::optional<std::size_t>(index) : std::nullopt;
  if (key.empty() || std::count(types.begin(), types.end(), key) != 1) return std::nullopt;
  return static_cast<std::size_t>(std::find(types.begin(), types.end(), key) - types.begin());
}

std::string no_item_message(const std::string& list, const std::string& key, const std::vector<std::string>& types) {
  const auto times = std::count(types.begin(), types.end(), key);
  if (times > 1) return fmt::format("{} has {} items of type '{}': name one by its index, from 0", list, times, key);
  std::string text = fmt::format("{} has no item '{}'", list, key);
  if (const auto near = nearest(key, types)) return text + fmt::format("; did you mean '{}'?", *near);
  if (types.empty()) return text + ": it is empty";
  std::string items;
  for (std::size_t i = 0; i < types.size(); ++i)
    items += (i == 0 ? "" : ", ") + (types[i].empty() ? fmt::format("{}", i) : fmt::format("{} ({})", i, types[i]));
  return text + "; items are " + items;
}

}  // namespace dismantle
