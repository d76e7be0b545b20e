/// The server behind `dismantle serve`: plans of the products of one folder, for one browser on this machine.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <set>
#include <string>

namespace dismantle::serve {

struct Settings {
  std::filesystem::path folder;
  std::filesystem::path program;         ///< `dismantle`, which does the work
  std::set<std::string> extensions;      ///< of files that it can read, in lower case, without the dot
  int port = 0;                          ///< 0: one that is free
  std::size_t max_upload = 200'000'000;  ///< bytes of one file
  double timeout = 600;                  ///< s, of a plan for which the page names none
};

/// Listens on 127.0.0.1 only. Every request but that for the first page needs the token of the address.
class Server {
 public:
  /// Takes the port. @throws Error when it is not free, or the folder cannot be used.
  explicit Server(Settings settings);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  int port() const;
  /// With the token.
  std::string address() const;
  /// Serves until it should stop, which is polled several times a second. A running job is then ended.
  void run(const std::function<bool()>& should_stop);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace dismantle::serve
