/// Names of products as people read them.
#pragma once

#include <TDF_Label.hxx>
#include <map>
#include <set>
#include <string>

namespace dismantle::step_import {

/// The name attribute of a label as UTF-8, empty when it has none. Control directives of ISO 10303-21 that Open CASCADE
/// leaves in it (\X2\00FC\X0\, \X\FC, \S\|) are decoded.
std::string name_of(const TDF_Label& label);

/// See name_of; for tests.
std::string decoded(const std::string& text);

/// Gives every body a name of its own: the first keeps the name, the next are "nut#2", "nut#3", never one that is
/// taken.
class UniqueNames {
 public:
  std::string take(const std::string& name);

 private:
  std::set<std::string> used_;
  std::map<std::string, int> last_;
};

}  // namespace dismantle::step_import
