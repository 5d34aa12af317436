#include "client/live/api_client.h"

#include <fmt/format.h>
#include <httplib.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <condition_variable>
#include <cstring>
#include <functional>
#include <mutex>
#include <thread>

#include "base/failure.h"
#include "base/keys/problem.h"
#include "base/text.h"

namespace shaken::client {

namespace fs = std::filesystem;

std::string url_encoded(std::string_view text) {
  static constexpr std::string_view kUnreserved = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-._~";
  std::string encoded;
  for (const char c : text) {
    if (kUnreserved.find(c) != std::string_view::npos) {
      encoded += c;
    } else {
      encoded += fmt::format("%{:02X}", static_cast<unsigned char>(c));
    }
  }
  return encoded;
}

std::string problem_text(const Json& problem) {
  return to_string(keys::Problem{.file = problem.value("file", ""),
                                 .line = problem.value("line", 0),
                                 .column = problem.value("column", 0),
                                 .path = problem.value("path", ""),
                                 .message = problem.value("message", "")});
}

struct ApiClient::Connection {
  static constexpr std::chrono::hours kLongest{24};
  using Clock = std::chrono::steady_clock;

  Connection(const fs::path& daemon_root, std::chrono::milliseconds how_patient)
      : root(daemon_root), socket(daemon_root / "shakend.sock"), patience(how_patient), http(socket.string()) {
    http.set_address_family(AF_UNIX);
    // A connection for each request: the daemon closes one that was silent for a second, maybe just as it is asked.
    http.set_keep_alive(false);
    http.set_connection_timeout(5);
    http.set_read_timeout(kLongest);  // watched over by `asked`
    http.set_write_timeout(30);
  }

  /// What `request` gives, unless the daemon falls silent meanwhile.
  httplib::Result asked(const std::function<httplib::Result()>& request);
  /// Whether the daemon answers an easy question.
  bool is_alive() const;

  /// The body of a 2xx answer.
  Json checked(const httplib::Result& result, const std::string& request) const;
  [[noreturn]] void fail_without_answer(httplib::Error error) const;

  fs::path root;
  fs::path socket;
  std::chrono::milliseconds patience;
  httplib::Client http;
};

bool ApiClient::Connection::is_alive() const {
  httplib::Client other(socket.string());
  other.set_address_family(AF_UNIX);
  other.set_connection_timeout(patience);
  other.set_read_timeout(patience);
  return static_cast<bool>(other.Get("/v1/status"));
}

httplib::Result ApiClient::Connection::asked(const std::function<httplib::Result()>& request) {
  std::mutex mutex;
  std::condition_variable_any ended;
  const std::jthread watch([&](const std::stop_token& stop) {
    Clock::time_point heard = Clock::now();
    std::unique_lock lock(mutex);
    while (!ended.wait_for(lock, stop, patience / 4, [&] { return stop.stop_requested(); })) {
      lock.unlock();
      if (is_alive()) heard = Clock::now();
      if (Clock::now() - heard > patience) http.stop();
      lock.lock();
    }
  });
  return request();
}

void ApiClient::Connection::fail_without_answer(httplib::Error error) const {
  if (access(socket.c_str(), W_OK) != 0 && (errno == EACCES || errno == EPERM)) {
    throw Failure(ExitCode::kNoDaemon, fmt::format("{}: {}: what listens there is another user's daemon",
                                                   socket.string(), std::strerror(errno)));
  }
  if (error == httplib::Error::Connection) {
    throw Failure(ExitCode::kNoDaemon, fmt::format("no daemon at {}: start one with `shakend --root {} &`",
                                                   socket.string(), shell_word(root.string())));
  }
  throw Failure(ExitCode::kNoDaemon, fmt::format("the daemon at {} gave no answer ({}): see {}", socket.string(),
                                                 httplib::to_string(error), (root / "shakend.log").string()));
}

Json ApiClient::Connection::checked(const httplib::Result& result, const std::string& request) const {
  if (!result) fail_without_answer(result.error());
  Json body = Json::parse(result->body, nullptr, false);
  const int status = result->status;
  if (!body.is_object()) {
    throw Failure(ExitCode::kFailed, fmt::format("{}: the answer (status {}) is not a JSON object: is another program "
                                                 "listening on {}?",
                                                 request, status, socket.string()));
  }
  if (status >= 200 && status < 300) return body;

  std::string message = fmt::format("{}: status {}", request, status);
  if (const auto error = body.find("error"); error != body.end() && error->is_string()) {
    message = error->get<std::string>();
  }
  if (const auto problems = body.find("problems"); problems != body.end() && problems->is_array()) {
    message = "refused, with " + counted(problems->size(), "problem");
    for (const Json& problem : *problems) message.append("\n").append(problem_text(problem));
  }
  throw Failure(status < 500 ? ExitCode::kBadInput : ExitCode::kFailed, message);
}

ApiClient::ApiClient(const fs::path& root, std::chrono::milliseconds patience) {
  // A longer path would be cut by the kernel's interface, and another socket be opened.
  const std::size_t longest = sizeof(sockaddr_un::sun_path) - 1;
  if ((root / "shakend.sock").string().size() > longest) {
    throw Failure(ExitCode::kBadInput, fmt::format("the root directory's path is too long for a Unix socket (limit {} "
                                                   "characters): {}",
                                                   longest, root.string()));
  }
  connection_ = std::make_unique<Connection>(root, patience);
}

ApiClient::ApiClient(ApiClient&&) noexcept = default;
ApiClient::~ApiClient() = default;

Json ApiClient::get(const std::string& path) {
  return connection_->checked(connection_->asked([&] { return connection_->http.Get(path.c_str()); }), "GET " + path);
}

Result<Json> ApiClient::find(const std::string& path) {
  const auto result = connection_->asked([&] { return connection_->http.Get(path.c_str()); });
  if (!result || result->status != 404) return connection_->checked(result, "GET " + path);
  const Json body = Json::parse(result->body, nullptr, false);
  return Error{body.is_object() ? body.value("error", "") : ""};
}

Json ApiClient::post(const std::string& path, const Json& body) {
  const auto post = [&] { return connection_->http.Post(path.c_str(), body.dump(), "application/json"); };
  return connection_->checked(connection_->asked(post), "POST " + path);
}

}  // namespace shaken::client
