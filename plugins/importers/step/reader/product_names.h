/// Readable names of products.
#pragma once

#include <TDF_Label.hxx>
#include <iosfwd>
#include <string>
#include <vector>

namespace dismantle::step_import {

/// How text of a file is encoded that is not UTF-8.
enum class TextEncoding { utf8, windows_1252, gb18030 };

/// Found from all text of a file that is not ASCII. Empty or unreadable files are UTF-8.
TextEncoding encoding_of(std::istream& file);

/// `text`: as Open CASCADE read it, each byte of the file as one character (read.step.codepage iso8859-1). Each word
/// that is UTF-8 stays, the others are converted.
std::string recoded(const std::string& text, TextEncoding encoding);

/// The name attribute of a label as UTF-8; empty when it has none. Decodes the control directives of ISO 10303-21 that
/// Open CASCADE leaves in it (\X2\00FC\X0\, \X\FC, \S\|).
std::string name_of(const TDF_Label& label, TextEncoding encoding = TextEncoding::utf8);

/// The decoding of name_of(), for tests.
std::string decoded(const std::string& text);

/// Makes names unique: the first keeps its name, the next become "nut#2", "nut#3", ..., skipping names that the file
/// gives to other bodies.
void make_unique(const std::vector<std::string*>& names);

}  // namespace dismantle::step_import
