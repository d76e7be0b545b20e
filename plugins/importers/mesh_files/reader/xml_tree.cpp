#include "xml_tree.h"

#include <fmt/format.h>

#include <fstream>
#include <string>

#include "dismantle/errors.h"
#include "xml_events.h"

namespace dismantle::mesh_files {

const XmlElement* XmlElement::child(std::string_view child_name) const {
  for (const auto& c : children)
    if (c->name == child_name) return c.get();
  return nullptr;
}

const XmlElement* XmlElement::find(std::initializer_list<std::string_view> path) const {
  const XmlElement* at = this;
  for (const std::string_view step : path)
    if (at = at->child(step); at == nullptr) return nullptr;
  return at;
}

std::string XmlElement::get(std::string_view attribute) const {
  for (const auto& [key, value] : attributes)
    if (key == attribute) return value;
  return {};
}

XmlElement read_xml(const std::filesystem::path& file) {
  constexpr std::size_t kDeepest = 1000;  // the tree is walked by recursion
  std::ifstream in(file, std::ios::binary);
  if (!in) throw InputError(file.string(), "cannot be opened");
  XmlElement top;
  std::vector<XmlElement*> open{&top};
  XmlEvents xml;
  xml.start = [&](const XmlTag& tag) {
    if (open.size() > kDeepest) throw std::runtime_error(fmt::format("elements nested more than {} deep", kDeepest));
    auto fresh = std::make_unique<XmlElement>();
    fresh->name = tag.name;
    for (const char** a = tag.attributes; *a != nullptr; a += 2) {
      const std::string_view key = a[0];
      fresh->attributes.emplace_back(key.substr(key.rfind('|') + 1), a[1]);
    }
    open.push_back(open.back()->children.emplace_back(std::move(fresh)).get());
  };
  xml.end = [&] { open.pop_back(); };
  xml.text = [&](std::string_view piece) { open.back()->text += piece; };
  try {
    std::string block(1 << 16, '\0');
    while (in.read(block.data(), static_cast<std::streamsize>(block.size())) || in.gcount() > 0)
      xml.feed(std::string_view(block).substr(0, static_cast<std::size_t>(in.gcount())));
    xml.feed({}, true);
  } catch (const std::runtime_error& e) {
    throw InputError(file.string(), fmt::format("cannot be read: {}", e.what()));
  }
  return std::move(*top.children.front());
}

}  // namespace dismantle::mesh_files
