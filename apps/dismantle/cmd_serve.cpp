// dismantle serve [FOLDER]
#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <unistd.h>

#include <cstdlib>

#include "command.h"
#include "console.h"
#include "dismantle/errors.h"
#include "dismantle/serve/server.h"
#include "dismantle/session/products.h"
#include "interrupt.h"
#include "settings.h"

namespace dismantle::app {
namespace {

namespace fs = std::filesystem;

struct ServeOptions {
  std::string folder = ".";
  int port = 0;
  bool no_browser = false;
  std::size_t max_upload = 200;  // MB
  double timeout = 600;          // s
};

/// Lets the desktop open the address. Command lines can be seen by other users, so that it goes through a file which
/// only this user can read.
bool open_browser(const std::string& address) {
  if (std::getenv("DISPLAY") == nullptr && std::getenv("WAYLAND_DISPLAY") == nullptr) return false;
  std::string file = (fs::temp_directory_path() / "dismantle-XXXXXX.html").string();
  const int descriptor = ::mkstemps(file.data(), 5);
  if (descriptor < 0) return false;
  const std::string page = fmt::format("<!doctype html><meta http-equiv=\"refresh\" content=\"0;url={}\">\n", address);
  const bool written = ::write(descriptor, page.data(), page.size()) == static_cast<ssize_t>(page.size());
  ::close(descriptor);
  if (!written) return false;
  std::string program = "xdg-open";
  char* const command[] = {program.data(), file.data(), nullptr};
  posix_spawnattr_t attributes;
  if (::posix_spawnattr_init(&attributes) != 0) return false;
  ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSID);  // Ctrl-C here does not close the browser
  pid_t child = 0;
  const bool started = ::posix_spawnp(&child, program.c_str(), nullptr, &attributes, command, environ) == 0;
  ::posix_spawnattr_destroy(&attributes);
  return started;
}

int serve(const ServeOptions& options) {
  Console console({});
  const Session session;
  warn_of_problems(session, console);
  RunContext context = context_of(session, console);
  serve::Server server({.folder = options.folder,
                        .program = fs::read_symlink("/proc/self/exe"),
                        .extensions = readable_extensions(session),
                        .port = options.port,
                        .max_upload = options.max_upload * 1'000'000,
                        .timeout = options.timeout});
  console.text(fmt::format("{}\n", server.address()));
  std::fflush(stdout);
  if (options.no_browser || !open_browser(server.address())) console.line("open this address in a browser");
  console.line("Ctrl-C ends the server; what is planned stays in the folder");
  server.run([&] { return context.cancel.cancelled(); });
  return kComplete;
}

}  // namespace

void add_serve(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("serve", "Plan, look at and change the products of a folder in a browser");
  auto options = std::make_shared<ServeOptions>();
  command->add_option("FOLDER", options->folder, "Folder of the files and plans; default: the current one")
      ->option_text(" ");
  command->add_option("--port", options->port, "Port on 127.0.0.1; default: one that is free")
      ->option_text("N")
      ->check(CLI::Range(0, 65535).description(""));
  command->add_flag("--no-browser", options->no_browser, "Only print the address")->option_text(" ");
  command->add_option("--max-upload", options->max_upload, "Largest file that can be uploaded, default 200")
      ->option_text("MB")
      ->check(CLI::Range(1, 100'000).description(""));
  command->add_option("--timeout", options->timeout, "Time limit of a plan, unless the page names one; default 600")
      ->option_text("S")
      ->check(CLI::Range(0.001, 86400.0).description(""));
  command->footer(
      "Only programs on this machine can reach the server, and only with the token in the address. Plans are kept in\n"
      "FOLDER/NAME.plan, as from 'dismantle plan'; FOLDER/NAME.yaml is the configuration to plan NAME with, if there\n"
      "is one. The first Ctrl-C ends the server and a running job; exit status 0.\n"
      "Example:\n"
      "  dismantle serve products --no-browser");
  command->callback([&action, options] { action = [options] { return serve(*options); }; });
}

}  // namespace dismantle::app
