/// What all writers of a book's content share.
#pragma once

#include <fmt/format.h>

#include <string>
#include <utility>

#include "content.h"
#include "dismantle/plan_io/motion_words.h"
#include "words.h"

namespace dismantle {

/// What a book is made of, and texts in its unit and language.
struct ContentBasis {
  const Plan& plan;
  const Assembly& assembly;
  const BookOptions& options;
  InputFrame frame;
  TextUnit unit;
  BookWords words;

  /// A label with its places filled.
  template <class... Args>
  std::string said(const char* english, Args&&... args) const {
    return fmt::format(fmt::runtime(words.label(english)), args...);
  }

  void fact(Facts& facts, const char* name, std::string value) const {
    facts.emplace_back(words.label(name), std::move(value));
  }

  std::string length_of(double input_units) const {
    return fmt::format("{} {}", figure_text(unit.factor * input_units), unit.name);
  }
};

}  // namespace dismantle
