#include "dismantle/serve/server.h"

#include <fmt/format.h>
#include <httplib.h>
#include <sys/socket.h>

#include <cmath>
#include <mutex>
#include <thread>

#include "access.h"
#include "constraints.h"
#include "dismantle/errors.h"
#include "dismantle/geometry/direction.h"
#include "dismantle/plan_io/read_file.h"
#include "dismantle/plan_io/write_file.h"
#include "folder.h"
#include "jobs.h"
#include "page.h"
#include "plan_view.h"
#include "upload.h"

namespace dismantle::serve {
namespace {

namespace fs = std::filesystem;
using httplib::Request;
using httplib::Response;

constexpr double kLongest = 86400;                 // s, the largest time limit that the page may name
constexpr std::size_t kLargestQuestion = 1 << 20;  // bytes of JSON
constexpr const char* kBook = "book";              // kind of a job

/// What is answered instead.
struct Refusal {
  int status;
  std::string message;
};

void answer(Response& response, const nlohmann::json& json, int status = 200) {
  response.status = status;
  // Names of files that are no UTF-8 have no entry; texts of programs may be cut in a character.
  response.set_content(json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace), "application/json");
}

nlohmann::json question_of(const Request& request) {
  if (request.body.size() > kLargestQuestion) throw Refusal{413, "the request is too large"};
  auto json = nlohmann::json::parse(request.body, nullptr, false);
  if (!json.is_object()) throw Refusal{400, "the request is no JSON object"};
  return json;
}

std::string text_in(const nlohmann::json& question, const char* key) {
  if (!question.contains(key) || !question[key].is_string()) throw Refusal{400, fmt::format("'{}' is missing", key)};
  return question[key].get<std::string>();
}

const char* type_of(const std::string& file) {
  const std::string extension = extension_of(file);
  if (extension == ".html") return "text/html; charset=utf-8";
  if (extension == ".json") return "application/json";
  if (extension == ".glb") return "model/gltf-binary";
  if (extension == ".pdf") return "application/pdf";
  return "text/plain; charset=utf-8";
}

}  // namespace

class Server::Impl {
 public:
  explicit Impl(Settings settings)
      : settings_(std::move(settings)), folder_(opened(settings_.folder), with_dots(settings_.extensions)) {
    // Not the option of cpp-httplib that lets two processes share a port.
    http_.set_socket_options([](socket_t socket) {
      const int yes = 1;
      ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    });
    http_.set_keep_alive_max_count(1);  // what a refused request still sends is never taken for a request
    http_.set_payload_max_length(settings_.max_upload);
    http_.set_default_headers({{"X-Content-Type-Options", "nosniff"},
                               {"Referrer-Policy", "no-referrer"},
                               {"Cross-Origin-Resource-Policy", "same-origin"},
                               {"Cache-Control", "no-store"}});
    http_.set_pre_routing_handler([this](const Request& request, Response& response) {
      return admitted(request, response) ? httplib::Server::HandlerResponse::Unhandled
                                         : httplib::Server::HandlerResponse::Handled;
    });
    add_questions();
    add_changes();
    constexpr const char* loopback = "127.0.0.1";
    port_ = settings_.port;
    if (port_ == 0)
      port_ = http_.bind_to_any_port(loopback);
    else if (!http_.bind_to_port(loopback, port_))
      port_ = -1;
    if (port_ <= 0) throw Error(fmt::format("port {} cannot be used: choose another one with --port", settings_.port));
  }

  int port() const { return port_; }
  std::string address() const { return fmt::format("http://127.0.0.1:{}/?token={}", port_, token_); }

  void run(const std::function<bool()>& should_stop) {
    std::thread listener([this] { http_.listen_after_bind(); });
    jobs_.run(
        should_stop, [this](const Job& job) { folder_.discard(job.product); },
        [this](const Job& job, bool good) {
          if (job.kind == kBook) return;  // it is beside its plan
          good ? folder_.install(job.product) : folder_.discard(job.product);
        });
    http_.stop();
    listener.join();
  }

 private:
  static fs::path opened(const fs::path& folder) {
    std::error_code error;
    fs::path path = fs::canonical(folder, error);
    if (error || !fs::is_directory(path, error)) throw InputError(folder.string(), "it is no folder that can be read");
    return path;
  }
  static std::set<std::string> with_dots(const std::set<std::string>& extensions) {
    std::set<std::string> out;
    for (const std::string& extension : extensions) out.insert("." + extension);
    return out;
  }

  bool admitted(const Request& request, Response& response) const {
    const auto refuse = [&](int status, const char* message) {
      answer(response, {{"error", message}}, status);
      return false;
    };
    if (request.get_header_value_count("Host") != 1 || !allowed_host(request.get_header_value("Host"), port_))
      return refuse(403, "this server is only for its own address");
    if (request.get_header_value_count("Origin") > 1 || !allowed_origin(request.get_header_value("Origin"), port_))
      return refuse(403, "other pages may not ask this server");
    if (request.path == "/" && request.method == "GET") return true;
    const std::string given = request.has_header("X-Dismantle-Token") ? request.get_header_value("X-Dismantle-Token")
                                                                      : request.get_param_value("token");
    return same_token(given, token_) || refuse(401,
                                               "the token is missing or wrong: open the address that "
                                               "'dismantle serve' prints");
  }

  using Handler = std::function<void(const Request&, Response&)>;
  /// Turns what a handler throws into an answer.
  static httplib::Server::Handler guarded(Handler handler) {
    return [handler = std::move(handler)](const Request& request, Response& response) {
      try {
        handler(request, response);
      } catch (const Refusal& e) {
        answer(response, {{"error", e.message}}, e.status);
      } catch (const std::exception& e) {
        answer(response, {{"error", e.what()}}, 500);
      }
    };
  }
  /// One change at a time. The question names a product without a running job.
  void on_change(const char* path, std::function<void(const Entry&, const nlohmann::json&)> change) {
    http_.Post(path, guarded([this, change = std::move(change)](const Request& request, Response& response) {
                 const std::lock_guard lock(changes_);
                 const nlohmann::json question = question_of(request);
                 const Entry entry = entry_of(text_in(question, "name"));
                 if (jobs_.busy(entry.name)) throw Refusal{409, "wait for the end of its job, or cancel it"};
                 change(entry, question);
                 answer(response, {{"ok", true}});
               }));
  }

  Entry entry_of(const std::string& name) const {
    auto entry = folder_.entry(name);
    if (!entry) throw Refusal{404, "there is no such product in the folder"};
    return *entry;
  }

  /// `job` was read before `entry`: a job that is done has then changed all that is told of the product.
  nlohmann::json state_of(const std::optional<JobReport>& job, const Entry& entry) const {
    nlohmann::json out = {{"name", entry.name},
                          {"file", entry.input.filename().string()},
                          {"has_plan", entry.has_plan},
                          {"earlier", entry.earlier},
                          {"has_book", folder_.plan_file(entry.name, "book.pdf").has_value()},
                          {"plan", folder_.summary(entry.name)}};
    if (job) out["job"] = to_json(*job);
    return out;
  }

  /// Steps and parts of the plan, and the constraints that were chosen. @throws Error for files that cannot be read.
  nlohmann::json known_of(const std::string& name) const {
    nlohmann::json out = nlohmann::json::object();
    if (const auto file = folder_.plan_file(name, "plan.json")) out = plan_view(read_file(*file));
    if (const auto file = folder_.constraints(name)) {
      out["yaml"] = read_file(*file);
      out["constraints"] = constraints_in(out["yaml"].get<std::string>());
    }
    return out;
  }

  void add_questions() {
    http_.Get("/", [](const Request&, Response& response) {
      response.set_header("Content-Security-Policy",
                          "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; connect-src "
                          "'self'; frame-src 'self'; img-src data:; form-action 'none'; base-uri 'none'; "
                          "frame-ancestors 'none'");
      response.set_content(kPage, "text/html; charset=utf-8");
    });
    http_.Get("/api/state", guarded([this](const Request&, Response& response) {
                nlohmann::json products = nlohmann::json::array();
                const std::map<std::string, JobReport> jobs = jobs_.reports();
                for (const Entry& entry : folder_.entries()) {
                  const auto job = jobs.find(entry.name);
                  products.push_back(state_of(job == jobs.end() ? std::nullopt : std::optional(job->second), entry));
                }
                answer(response, {{"folder", folder_.path().filename().string()},
                                  {"products", products},
                                  {"extensions", folder_.extensions()},
                                  {"max_upload", settings_.max_upload},
                                  {"timeout", settings_.timeout}});
              }));
    http_.Get("/api/product", guarded([this](const Request& request, Response& response) {
                const std::string name = request.get_param_value("name");
                const auto job = jobs_.report(name);
                const Entry entry = entry_of(name);
                nlohmann::json out = state_of(job, entry);
                try {
                  out.update(known_of(entry.name));
                } catch (const Error& e) {
                  out["problem"] = e.what();  // it can still be planned anew
                }
                answer(response, out);
              }));
    http_.Get(R"(/plan/([^/]+)/([^/]+))", guarded([this](const Request& request, Response& response) {
                const Entry entry = entry_of(request.matches[1]);
                const std::string name = request.matches[2];
                const auto file = folder_.plan_file(entry.name, name);
                if (!file) throw Refusal{404, "there is no such file of the plan"};
                // The page is data of the folder: it runs without the rights of this server.
                if (extension_of(name) == ".html")
                  response.set_header(
                      "Content-Security-Policy",
                      "sandbox allow-scripts allow-downloads; connect-src 'none'; frame-ancestors 'self'");
                response.set_content(read_file(*file), type_of(name));
              }));
  }

  void add_changes() {
    http_.Put("/api/upload", [this](const Request& request, Response& response, const httplib::ContentReader& content) {
      guarded([&](const Request&, Response&) { upload(request, response, content); })(request, response);
    });
    http_.Post("/api/cancel", guarded([this](const Request& request, Response& response) {
                 const Entry entry = entry_of(text_in(question_of(request), "name"));
                 if (!jobs_.cancel(entry.name)) throw Refusal{409, "it has no job that runs or waits"};
                 answer(response, {{"ok", true}});
               }));
    on_change("/api/plan", [this](const Entry& entry, const nlohmann::json& question) { plan(entry, question); });
    on_change("/api/move", [this](const Entry& entry, const nlohmann::json& question) { move(entry, question); });
    on_change("/api/book", [this](const Entry& entry, const nlohmann::json&) { book(entry); });
    on_change("/api/constraints", [this](const Entry& entry, const nlohmann::json& q) { constrain(entry.name, q); });
    on_change("/api/undo", [this](const Entry& entry, const nlohmann::json&) {
      if (!folder_.undo(entry.name)) throw Refusal{409, "there is no earlier plan"};
    });
  }

  void upload(const Request& request, Response& response, const httplib::ContentReader& content) {
    const std::string name = request.get_param_value("name");
    if (!plain_name(name)) throw Refusal{400, "the name must be that of a file, without a path"};
    if (!folder_.extensions().contains(extension_of(name)))
      throw Refusal{415, "files with this extension cannot be read"};
    const fs::path file = folder_.path() / name;
    const auto taken = [&] {
      return folder_.entry(file.stem().string()).has_value() || folder_.entry(name).has_value();
    };
    constexpr const char* kTaken = "there is a product of this name already: give the file another name";
    if (taken()) throw Refusal{409, kTaken};
    Upload upload(folder_.path(), settings_.max_upload);
    const bool whole = content([&](const char* data, std::size_t size) { return upload.add({data, size}); });
    if (upload.too_large() || response.status == 413)
      throw Refusal{413, fmt::format("the file is larger than {} bytes", settings_.max_upload)};
    if (!whole) throw Refusal{400, "the file did not arrive whole"};
    const std::lock_guard lock(changes_);
    if (taken() || !upload.keep_as(file)) throw Refusal{409, kTaken};
    answer(response, {{"ok", true}}, 201);
  }

  void start(const Entry& entry, const char* kind, std::vector<std::string> arguments, const fs::path& output,
             double timeout) {
    if (entry.input.empty()) throw Refusal{409, "the input of this plan is not in the folder"};
    arguments.insert(arguments.begin(), settings_.program.string());
    arguments.insert(arguments.end(), {"-o", output.string(), "--format", "json"});
    // The program ends by itself at its time limit; what it does after that takes time, too.
    Job job{.product = entry.name, .kind = kind, .command = std::move(arguments), .wall = 2 * timeout + 600};
    if (!jobs_.add(std::move(job))) throw Refusal{503, "too many jobs are waiting"};
  }

  void plan(const Entry& entry, const nlohmann::json& question) {
    double timeout = settings_.timeout;
    if (question.contains("timeout")) {
      if (!question["timeout"].is_number()) throw Refusal{400, "'timeout' must be a number of seconds"};
      timeout = question["timeout"].get<double>();
    }
    if (!(timeout > 0) || timeout > kLongest)
      throw Refusal{400, fmt::format("'timeout' must be above 0 and at most {:.0f} s", kLongest)};
    std::vector<std::string> arguments{"plan", entry.input.string(), "--timeout", fmt::format("{}", timeout)};
    if (question.contains("up")) {
      if (!question["up"].is_string() || !direction_named(question["up"].get<std::string>()))
        throw Refusal{400, fmt::format("'up' must be a direction: {}", kDirectionForms)};
      arguments.push_back("--up=" + question["up"].get<std::string>());
    }
    if (const auto settings = folder_.settings(entry.name))
      arguments.insert(arguments.end(), {"-c", settings->string()});
    start(entry, "plan", std::move(arguments), folder_.fresh(entry.name), timeout);
  }

  fs::path planned(const Entry& entry) const {
    const auto plan = folder_.plan_file(entry.name, "plan.json");
    if (!plan) throw Refusal{409, "there is no plan yet"};
    return *plan;
  }

  /// Instructions for the plan as it is.
  void book(const Entry& entry) {
    const fs::path plan = planned(entry);
    std::vector<std::string> arguments{"book", plan.string(), "--assembly", entry.input.string()};
    if (const auto notes = folder_.notes(entry.name)) arguments.insert(arguments.end(), {"--notes", notes->string()});
    start(entry, kBook, std::move(arguments), fs::path(plan).replace_filename("book.pdf"), settings_.timeout);
  }

  /// Takes effect when it is planned again.
  void constrain(const std::string& name, const nlohmann::json& question) {
    if (!question.contains("constraints")) throw Refusal{400, "'constraints' is missing"};
    const nlohmann::json known = known_of(name);
    std::set<std::string> parts;
    for (const auto& part : known.value("parts", nlohmann::json::array())) parts.insert(part.get<std::string>());
    const fs::path own = folder_.path() / (name + ".yaml");
    std::string yaml;
    try {
      yaml = constraints_yaml(question["constraints"], parts, folder_.has_file(own) ? own.filename().string() : "");
    } catch (const Error& e) {
      throw Refusal{400, e.what()};
    }
    const fs::path file = folder_.path() / (name + ".constraints.yaml");
    if (yaml.empty())
      fs::remove(file);
    else
      write_file(file, yaml);
  }

  void move(const Entry& entry, const nlohmann::json& question) {
    const fs::path plan = planned(entry);
    const bool before = question.contains("before");
    const char* const beside = before ? "before" : "after";
    for (const char* key : {"step", beside})
      if (!question.contains(key) || !question[key].is_number_unsigned() || question[key].get<std::uint64_t>() == 0)
        throw Refusal{400, fmt::format("'{}' must be the number of a step", key)};
    start(entry, "edit",
          {"edit", plan.string(), "--assembly", entry.input.string(), "--move-step",
           std::to_string(question["step"].get<std::uint64_t>()), fmt::format("--{}", beside),
           std::to_string(question[beside].get<std::uint64_t>())},
          folder_.fresh(entry.name), settings_.timeout);
  }

  const Settings settings_;
  const std::string token_ = new_token();
  Folder folder_;
  Jobs jobs_;
  std::mutex changes_;
  int port_ = 0;
  httplib::Server http_;
};

Server::Server(Settings settings) : impl_(std::make_unique<Impl>(std::move(settings))) {}
Server::~Server() = default;
int Server::port() const { return impl_->port(); }
std::string Server::address() const { return impl_->address(); }
void Server::run(const std::function<bool()>& should_stop) { impl_->run(should_stop); }

}  // namespace dismantle::serve
