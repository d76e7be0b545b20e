/// XML as events, through expat.
#pragma once

#include <expat.h>

#include <exception>
#include <functional>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

namespace dismantle::mesh_files {

/// Start tag of an element. Names of elements and attributes: name space, '|', local name; or the local name alone.
struct XmlTag {
  std::string space, name;
  const char** attributes = nullptr;

  /// Value of an attribute; nothing when it is not there.
  std::optional<std::string_view> find(std::string_view attribute) const {
    for (const char** a = attributes; *a != nullptr; a += 2)
      if (attribute == *a) return a[1];
    return std::nullopt;
  }
};

/// Parses a document that comes piece by piece. What `start` or `end` throws leaves feed().
class XmlEvents {
 public:
  std::function<void(const XmlTag&)> start;
  std::function<void()> end;
  std::map<std::string, std::string> prefixes;  ///< name spaces that were declared so far

  XmlEvents() : parser_(XML_ParserCreateNS(nullptr, '|')) {
    XML_SetUserData(parser_, this);
    XML_SetElementHandler(
        parser_,
        [](void* self, const char* name, const char** attributes) {
          static_cast<XmlEvents*>(self)->guarded([&](XmlEvents& events) { events.begin(name, attributes); });
        },
        [](void* self, const char*) {
          static_cast<XmlEvents*>(self)->guarded([](XmlEvents& events) {
            if (events.end) events.end();
          });
        });
    XML_SetStartNamespaceDeclHandler(parser_, [](void* self, const char* prefix, const char* uri) {
      static_cast<XmlEvents*>(self)->prefixes[prefix ? prefix : ""] = uri ? uri : "";
    });
    // Entities can multiply their content; no format that is read here declares any.
    XML_SetStartDoctypeDeclHandler(parser_, [](void* self, const char*, const char*, const char*, int) {
      static_cast<XmlEvents*>(self)->guarded(
          [](XmlEvents&) { throw std::runtime_error("a document type declaration is not allowed"); });
    });
  }
  ~XmlEvents() { XML_ParserFree(parser_); }
  XmlEvents(const XmlEvents&) = delete;
  XmlEvents& operator=(const XmlEvents&) = delete;

  /// @throws std::runtime_error with the line for damaged XML.
  void feed(std::string_view bytes, bool last = false) {
    const XML_Status status = XML_Parse(parser_, bytes.data(), static_cast<int>(bytes.size()), last);
    if (thrown_) std::rethrow_exception(thrown_);
    if (status != XML_STATUS_OK)
      throw std::runtime_error("line " + std::to_string(line()) + ": " + XML_ErrorString(XML_GetErrorCode(parser_)));
  }
  unsigned long line() const { return XML_GetCurrentLineNumber(parser_); }

 private:
  void begin(std::string_view name, const char** attributes) {
    XmlTag tag;
    const auto bar = name.rfind('|');
    if (bar != name.npos) tag.space = name.substr(0, bar);
    tag.name = bar == name.npos ? name : name.substr(bar + 1);
    tag.attributes = attributes;
    if (start) start(tag);
  }

  /// No exception may pass through expat, which is C.
  template <class F>
  void guarded(F f) {
    if (thrown_) return;
    try {
      f(*this);
    } catch (...) {
      thrown_ = std::current_exception();
      XML_StopParser(parser_, XML_FALSE);
    }
  }

  XML_Parser parser_;
  std::exception_ptr thrown_;
};

}  // namespace dismantle::mesh_files
