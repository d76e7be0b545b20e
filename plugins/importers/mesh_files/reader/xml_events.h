/// XML as events, through expat.
#pragma once

#include <expat.h>
#include <iconv.h>

#include <algorithm>
#include <exception>
#include <functional>
#include <iterator>
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
  std::function<void(std::string_view)> text;   ///< a piece of character data
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
    XML_SetCharacterDataHandler(parser_, [](void* self, const char* bytes, int length) {
      static_cast<XmlEvents*>(self)->guarded([&](XmlEvents& events) {
        if (events.text) events.text({bytes, static_cast<std::size_t>(length)});
      });
    });
    XML_SetUnknownEncodingHandler(
        parser_, [](void*, const char* name, XML_Encoding* encoding) { return single_byte(name, *encoding); }, nullptr);
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
  /// Fills the table of an encoding with one byte for each character, such as windows-1252, as iconv has it. Others
  /// than these, and those that expat knows, are refused as unknown.
  static int single_byte(const char* name, XML_Encoding& encoding) {
    const iconv_t tool = ::iconv_open("UCS-4BE", name);
    if (tool == reinterpret_cast<iconv_t>(-1)) return XML_STATUS_ERROR;
    bool plain = true;  // ASCII is itself: else it is no encoding of one byte, or one that no XML is written in
    for (int byte = 0; byte < 256; ++byte) {
      char from = static_cast<char>(byte), wide[4] = {};
      char *in = &from, *out = wide;
      std::size_t left = 1, room = sizeof wide;
      ::iconv(tool, nullptr, nullptr, nullptr, nullptr);
      const bool done = ::iconv(tool, &in, &left, &out, &room) != static_cast<std::size_t>(-1) && room == 0;
      encoding.map[byte] = -1;
      if (done)
        encoding.map[byte] = (static_cast<unsigned char>(wide[1]) << 16) | (static_cast<unsigned char>(wide[2]) << 8) |
                             static_cast<unsigned char>(wide[3]);
      if (byte < 0x80) plain = plain && encoding.map[byte] == byte;
    }
    ::iconv_close(tool);
    // Of an encoding of several bytes the bytes that begin a character stand for none.
    const auto undefined = std::count(std::begin(encoding.map) + 0x80, std::end(encoding.map), -1);
    return plain && undefined <= 0x20 ? XML_STATUS_OK : XML_STATUS_ERROR;
  }

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
