/// An XML file as a tree in memory, for formats whose elements refer to each other.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace dismantle::mesh_files {

struct XmlElement {
  std::string name;  ///< without its name space
  std::string text;  ///< UTF-8, of all pieces between its children
  std::vector<std::pair<std::string, std::string>> attributes;
  std::vector<std::unique_ptr<XmlElement>> children;

  /// The first child of that name; nullptr: there is none.
  const XmlElement* child(std::string_view child_name) const;
  /// The first grandchild along `path`; nullptr: there is none.
  const XmlElement* find(std::initializer_list<std::string_view> path) const;
  /// Empty when it is not there.
  std::string get(std::string_view attribute) const;
};

/// @throws InputError naming the file and the line for damaged XML, and for elements nested more than 1000 deep.
XmlElement read_xml(const std::filesystem::path& file);

}  // namespace dismantle::mesh_files
