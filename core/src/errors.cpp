#include "dismantle/errors.h"


#include <utility>
#include "text.h"

namespace dismantle {
namespace {

std::string lines(const std::vector<Diagnostic>& diagnostics) {
  std::string text;
  for (const auto& d : diagnostics) {
    if (!text.empty()) text += '\n';
    text += d.text();
  }
  return text.empty() ? "invalid configuration" : text;
}

std::string prefixed(const std::string& subject, const std::string& problem) {
  return subject.empty() ? problem : text::join(subject, ": ", problem);
}

}  // namespace

Error::Error(const std::string& what) : std::runtime_error(what) {}
Error::~Error() = default;

InputError::InputError(std::string subject, const std::string& problem)
    : Error(prefixed(subject, problem)), subject_(std::move(subject)) {}
InputError::~InputError() = default;

std::string Diagnostic::text() const {
  std::string place = file;
  if (line > 0) place += text::join(":", line);
  if (line > 0 && column > 0) place += text::join(":", column);
  return place.empty() ? text::join("error: ", message) : text::join(place, ": error: ", message);
}

ConfigError::ConfigError(std::vector<Diagnostic> diagnostics)
    : Error(lines(diagnostics)), diagnostics_(std::move(diagnostics)) {}
ConfigError::~ConfigError() = default;

PluginError::PluginError(std::string file, const std::string& problem)
    : Error(prefixed(file, problem)), file_(std::move(file)) {}
PluginError::~PluginError() = default;

}  // namespace dismantle
