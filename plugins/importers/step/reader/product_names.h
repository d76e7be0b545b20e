/// Readable names of products.
#pragma once

#include <TDF_Label.hxx>
#include <string>
#include <vector>

namespace dismantle::step_import {

/// The name attribute of a label as UTF-8; empty when it has none. Decodes the control directives of ISO 10303-21 that
/// Open CASCADE leaves in it (\X2\00FC\X0\, \X\FC, \S\|).
std::string name_of(const TDF_Label& label);

/// The decoding of name_of(), for tests.
std::string decoded(const std::string& text);

/// Makes names unique: the first keeps its name, the next become "nut#2", "nut#3", ..., skipping names that the file
/// gives to other bodies.
void make_unique(const std::vector<std::string*>& names);

}  // namespace dismantle::step_import
