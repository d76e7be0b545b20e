#include "suite/seeds.h"

#include <fmt/format.h>

#include <charconv>
#include <set>

namespace dismantle::bench {
namespace {

/// Limit of one range: more seeds are probably a typing error and would use much memory.
constexpr std::size_t kMaxSeeds = 100000;

/// "1..6" or a number.
bool add_seeds(const std::string& text, std::vector<std::int64_t>& seeds) {
  const std::size_t dots = text.find("..");
  const auto number = [](const std::string& word, std::int64_t& value) {
    const char* end = word.data() + word.size();
    const auto read = std::from_chars(word.data(), end, value);
    return read.ec == std::errc{} && read.ptr == end && value >= 0;
  };
  std::int64_t first = 0, last = 0;
  if (!number(text.substr(0, dots), first)) return false;
  last = first;
  if (dots != std::string::npos && !number(text.substr(dots + 2), last)) return false;
  if (last < first || static_cast<std::uint64_t>(last - first) >= kMaxSeeds) return false;
  for (std::int64_t seed = first; seed <= last; ++seed) seeds.push_back(seed);
  return true;
}

}  // namespace

std::vector<std::int64_t> read_seeds(const ConfigNode& seeds, const std::string& place,
                                     std::vector<Diagnostic>& problems) {
  std::vector<std::int64_t> out;
  const bool list = seeds.kind == ConfigNode::Kind::sequence;
  for (const auto& item : list ? seeds.items : std::vector<ConfigNode>{seeds})
    if (!item.is_scalar() || !add_seeds(item.scalar, out))
      problems.push_back(item.mark.error(
          fmt::format("{}seeds must be whole numbers >= 0 or ranges such as 1..6 (at most {}), got {}", place,
                      kMaxSeeds, item.is_scalar() ? "'" + item.scalar + "'" : std::string(item.kind_name()))));
  if (std::set<std::int64_t>(out.begin(), out.end()).size() != out.size())
    problems.push_back(seeds.mark.error(place + "seeds names a seed twice"));
  if (list && seeds.items.empty()) problems.push_back(seeds.mark.error(place + "seeds is empty"));
  return out;
}

}  // namespace dismantle::bench
