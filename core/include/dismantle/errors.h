/// Exceptions: broken input, configuration or plugins. Outcomes of planning are values, never exceptions.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "dismantle/export.h"

namespace dismantle {

/// Base of all errors that Dismantle throws on purpose. Virtual functions live in the core, so that
/// the types are recognised across shared libraries.
class DISMANTLE_API Error : public std::runtime_error {
 public:
  explicit Error(const std::string& what);
  ~Error() override;
};

/// Unusable input: names the file or part. Exit status 3.
class DISMANTLE_API InputError : public Error {
 public:
  InputError(std::string subject, const std::string& problem);
  ~InputError() override;
  const std::string& subject() const { return subject_; }

 private:
  std::string subject_;
};

/// One thing wrong with a configuration. Lines and columns count from 1; 0 = unknown.
struct Diagnostic {
  std::string file;
  int line = 0;
  int column = 0;
  std::string message;
  DISMANTLE_API std::string text() const;  ///< `file:line:column: error: message`
};

/// All problems of a configuration together. Exit status 2.
class DISMANTLE_API ConfigError : public Error {
 public:
  explicit ConfigError(std::vector<Diagnostic> diagnostics);
  ~ConfigError() override;
  const std::vector<Diagnostic>& diagnostics() const { return diagnostics_; }

 private:
  std::vector<Diagnostic> diagnostics_;
};

/// A plugin that cannot be loaded or that broke its contract: names the file or id. Exit status 4.
class DISMANTLE_API PluginError : public Error {
 public:
  PluginError(std::string file, const std::string& problem);
  ~PluginError() override;
  const std::string& file() const { return file_; }

 private:
  std::string file_;
};

}  // namespace dismantle
