#include "dismantle/statics/model.h"

#include <fnmatch.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace dismantle::statics {
namespace {

std::vector<std::string> words_of(const std::string& text) {
  std::vector<std::string> words;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t to = std::min(text.find(',', from), text.size());
    const std::size_t first = text.find_first_not_of(' ', from),
                      last = text.find_last_not_of(' ', to == 0 ? 0 : to - 1);
    if (first < to && last != std::string::npos && last >= first) words.push_back(text.substr(first, last - first + 1));
    from = to + 1;
  }
  return words;
}

bool matches(const std::string& name, const std::string& pattern) {
  return name == pattern || fnmatch(pattern.c_str(), name.c_str(), 0) == 0;
}

}  // namespace

StatedModel::StatedModel(const std::string& fixed, double friction, const std::string& density)
    : fixed_(words_of(fixed)), friction_(friction) {
  for (const std::string& word : words_of(density)) {
    const std::size_t at = word.rfind('=');
    std::size_t used = 0;
    double value = 0;
    if (at != std::string::npos && at > 0 && at + 1 < word.size()) try {
        value = std::stod(word.substr(at + 1), &used);
      } catch (const std::exception&) {
        used = 0;
      }
    if (used == 0 || used != word.size() - at - 1 || !(value > 0) || !std::isfinite(value))
      throw std::invalid_argument("density: write NAME=G_PER_CM3 with a number above 0 instead of '" + word + "'");
    density_.emplace_back(word.substr(0, word.find_last_not_of(' ', at - 1) + 1), value);
  }
}

StabilityOptions StatedModel::options(const Assembly& assembly) const {
  StabilityOptions options;
  options.friction = friction_;
  for (const Part& part : assembly.parts) {
    options.fixed.push_back(std::any_of(fixed_.begin(), fixed_.end(),
                                        [&](const std::string& pattern) { return matches(part.name, pattern); }));
    options.density.push_back(part.density.value_or(1));
    for (const auto& [pattern, value] : density_)
      if (matches(part.name, pattern)) options.density.back() = value;
  }
  return options;
}

}  // namespace dismantle::statics
