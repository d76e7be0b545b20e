#include "crash_handler.h"

#include <dlfcn.h>
#include <execinfo.h>
#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstring>
#include <deque>
#include <string>
#include <vector>

#include "command.h"

namespace dismantle::app {
namespace {

struct KnownPlugin {
  std::string file, text;
  bool built_in;
};

/// Data for the handler, prepared in advance because the handler must not allocate. Lives as long as the process.
struct Facts {
  std::vector<KnownPlugin> plugins;
  RunNotes* notes = nullptr;
  AfterCrash after = AfterCrash::exit;
  bool json = false;
  std::string advice;
};
Facts* g_facts = nullptr;
std::atomic<bool> g_crashing{false};

const char* name_of(int signal) {
  switch (signal) {
    case SIGSEGV:
      return "SIGSEGV, a bad memory access";
    case SIGBUS:
      return "SIGBUS, a bad memory access";
    case SIGFPE:
      return "SIGFPE, a bad division";
    case SIGILL:
      return "SIGILL, code that is none";
    default:
      return "SIGABRT, it gave up by itself";
  }
}

/// Appends to a buffer of fixed size; safe in a signal handler.
struct Line {
  char text[4096];
  std::size_t size = 0;
  void add(const char* words) {
    while (*words != '\0' && size + 1 < sizeof text) text[size++] = *words++;
    text[size] = '\0';
  }
  /// Appends `words`, escaped for a JSON string.
  void add_escaped(const char* words) {
    for (; *words != '\0' && size + 3 < sizeof text; ++words) {
      if (static_cast<unsigned char>(*words) < 0x20) {
        text[size++] = ' ';
        continue;
      }
      if (*words == '"' || *words == '\\') text[size++] = '\\';
      text[size++] = *words;
    }
    text[size] = '\0';
  }
  void write_to(int stream) const {
    for (std::size_t done = 0; done < size;) {
      const ssize_t n = ::write(stream, text + done, size - done);
      if (n <= 0) return;
      done += static_cast<std::size_t>(n);
    }
  }
};

/// True for a file name NAME.so. Identifies a plugin that is still being loaded; names of other libraries contain a
/// version.
bool has_name_of_plugin(const char* file) {
  const std::size_t size = std::strlen(file);
  return size > 3 && std::strcmp(file + size - 3, ".so") == 0;
}

/// Appends the plugin nearest to the top of the stack. A third party's plugin takes precedence over ours.
void add_culprit(Line& line) {
  void* frames[256];
  const int count = ::backtrace(frames, 256);
  const KnownPlugin* ours = nullptr;
  const char* unknown = nullptr;
  for (int i = 0; i < count; ++i) {
    Dl_info info{};
    if (::dladdr(frames[i], &info) == 0 || info.dli_fname == nullptr) continue;
    bool known = false;
    for (const KnownPlugin& plugin : g_facts->plugins) {
      if (plugin.file != info.dli_fname) continue;
      known = true;
      if (!plugin.built_in) return line.add(plugin.text.c_str());
      if (ours == nullptr) ours = &plugin;
    }
    if (!known && unknown == nullptr && has_name_of_plugin(info.dli_fname)) unknown = info.dli_fname;
  }
  if (unknown != nullptr) {
    line.add("plugin file ");
    line.add(unknown);
  } else {
    line.add(ours != nullptr ? ours->text.c_str() : "Dismantle, outside of all plugins,");
  }
}

// backtrace and dladdr are not async-signal-safe, but the process is lost anyway. The alarm ends it if they hang.
extern "C" void on_crash(int number) {
  if (g_crashing.exchange(true)) {
    for (;;) ::pause();  // another thread is reporting
  }
  ::signal(SIGALRM, SIG_DFL);
  ::alarm(5);
  static Line what;
  add_culprit(what);
  what.add(" crashed (");
  what.add(name_of(number));
  what.add(")");
  g_facts->notes->culprit.set({what.text, what.size});
  if (g_facts->after == AfterCrash::hand_over) {
    ::signal(number, SIG_DFL);
    ::raise(number);
    sigset_t only;
    sigemptyset(&only);
    sigaddset(&only, number);
    ::sigprocmask(SIG_UNBLOCK, &only, nullptr);
    ::_exit(kPluginFailed);
  }
  for (const auto& [before, text, after] : {std::array<const char*, 3>{" at '", g_facts->notes->busy.get(), "'"},
                                            std::array<const char*, 3>{", with ", g_facts->notes->chosen.get(), ""}}) {
    if (*text == '\0') continue;
    what.add(before);
    what.add(text);
    what.add(after);
  }
  what.add("; ");
  const char* plan = g_facts->notes->plan.get();
  if (*plan != '\0') {
    what.add("the steps that were finished are in ");
    what.add(plan);
    what.add("; ");
  }
  what.add(g_facts->advice.c_str());
  static Line out;
  out.add("\ndismantle: error: ");
  out.add(what.text);
  out.add("\n");
  out.write_to(STDERR_FILENO);
  if (g_facts->json) {
    static Line json;
    json.add("{\"status\":\"error\",\"message\":\"");
    json.add_escaped(what.text);
    json.add("\",\"wall_seconds\":null,\"cpu_seconds\":null,\"peak_rss_mb\":null,\"plan\":");
    if (*plan != '\0') {
      json.add("\"");
      json.add_escaped(plan);
      json.add("\"}\n");
    } else {
      json.add("null}\n");
    }
    json.write_to(STDOUT_FILENO);
  }
  ::_exit(kPluginFailed);
}

}  // namespace

std::string advice_after_crash(bool isolated) {
  return std::string(isolated ? "" : "run it with --isolate, and the plan so far is finished; ") +
         "take another planner or simulator, try the plugin with 'dismantle plugins check FILE.so', and tell its "
         "author";
}

void report_crashes(const Registry* registry, RunNotes& notes, AfterCrash after, bool json) {
  // Never destroyed, because a crash may also happen while the process exits.
  static auto& all = *new std::deque<Facts>;
  Facts* facts = &all.emplace_back();
  for (const PluginFile& file : registry != nullptr ? registry->files() : std::deque<PluginFile>{})
    facts->plugins.push_back({file.path.string(),
                              fmt::format("plugin {} {} ({}{}{})", file.id, file.version, file.path.string(),
                                          file.url.empty() ? "" : ", ", file.url),
                              file.built_in});
  facts->notes = &notes;
  facts->after = after;
  facts->json = json;
  facts->advice = registry != nullptr
                      ? advice_after_crash(false)
                      : "if the plugin is none of Dismantle's own, take its file out of the plugin path "
                        "(DISMANTLE_PLUGIN_PATH, plugins.search_paths), and tell its author";
  g_facts = facts;
  void* warm[4];
  static_cast<void>(::backtrace(warm, 4));  // the first call loads a library
  // An alternative stack for the main thread, in case its own stack has overflowed.
  static char alternative[1 << 16];
  stack_t stack = {};
  stack.ss_sp = alternative;
  stack.ss_size = sizeof alternative;
  ::sigaltstack(&stack, nullptr);
  struct sigaction action = {};
  action.sa_handler = on_crash;
  action.sa_flags = SA_ONSTACK;
  sigemptyset(&action.sa_mask);
  for (const int number : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) ::sigaction(number, &action, nullptr);
}

}  // namespace dismantle::app
