#include "base/http/http_server.h"

#include <httplib.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <condition_variable>
#include <cstring>
#include <future>
#include <mutex>
#include <thread>
#include <utility>

#include "base/failure.h"
#include "base/http/http_connection.h"

namespace shaken::http {
namespace {

constexpr std::size_t kMostConnections = 256;
constexpr int kBacklog = SOMAXCONN;  // cpp-httplib has 5: clients that come in a burst would be turned away
constexpr int kUnusedPort = 80;      // cpp-httplib refuses port 0
constexpr const char* kLoopback = "127.0.0.1";

/// A thread for each connection: with a fixed pool, as many silent clients as it has threads would lock out the rest.
/// Beyond kMostConnections new ones wait to be accepted.
class ThreadPerConnection final : public httplib::TaskQueue {
 public:
  /// `listening_ended` is called before the last connections are waited for.
  explicit ThreadPerConnection(std::function<void()> listening_ended) : listening_ended_(std::move(listening_ended)) {}

  void enqueue(std::function<void()> serve) override {
    std::unique_lock lock(mutex_);
    ended_.wait(lock, [&] { return n_open_ < kMostConnections; });
    ++n_open_;
    lock.unlock();
    const auto connection = [this, serve = std::move(serve)] {
      try {
        serve();
      } catch (...) {  // out of memory, say: this connection ends, and no other
      }
      const std::lock_guard end(mutex_);
      --n_open_;
      ended_.notify_all();
    };
    try {
      std::thread(connection).detach();
    } catch (const std::exception&) {  // the system has no more threads, or no memory for one
      connection();
    }
  }

  void shutdown() override {
    listening_ended_();
    std::unique_lock lock(mutex_);
    ended_.wait(lock, [&] { return n_open_ == 0; });
  }

 private:
  std::function<void()> listening_ended_;
  std::mutex mutex_;
  std::condition_variable ended_;
  std::size_t n_open_ = 0;
};

/// For what cpp-httplib refuses by itself.
const char* explain(int status) {
  switch (status) {
    case 400:
      return "this is no HTTP request that can be read";
    case 414:
      return "the path is too long";
    case 417:
      return "the expectation cannot be met";
    default:
      return "the request cannot be answered";
  }
}

std::multimap<std::string, std::string> in_lower_case(const httplib::Headers& headers) {
  std::multimap<std::string, std::string> lower;
  for (const auto& [name, value] : headers) {
    std::string key = name;
    std::transform(key.begin(), key.end(), key.begin(), [](unsigned char c) { return std::tolower(c); });
    lower.emplace(std::move(key), value);
  }
  return lower;
}

std::string first_of(const std::multimap<std::string, std::string>& values, const std::string& name) {
  const auto found = values.find(name);
  return found == values.end() ? "" : found->second;
}

void put(const Reply& reply, httplib::Response& response) {
  response.status = reply.status;
  if (!reply.allow.empty()) response.set_header("Allow", reply.allow);
  for (const auto& [name, value] : reply.headers) response.set_header(name, value);
  if (!reply.stream) {
    response.set_content(reply.body, reply.type);
    return;
  }
  response.set_chunked_content_provider(reply.type, [stream = reply.stream](std::size_t, httplib::DataSink& sink) {
    std::optional<std::string> piece;
    try {
      piece = stream();
    } catch (const std::exception&) {
      return false;  // no last chunk: the client sees that it is cut off
    }
    if (!piece) {
      sink.done();
      return true;
    }
    return piece->empty() || sink.write(piece->data(), piece->size());
  });
}

/// cpp-httplib's server, on connections that count what a request takes.
class BoundedServer final : public httplib::Server {
 public:
  /// Whether only this process's user and root are answered: a Unix socket knows who connects.
  bool is_private = true;
  HttpServer::Gate gate;  ///< none: all may pass
  Headers headers;        ///< of every answer

  /// After the listening has ended. Whether that was not by stop(): cpp-httplib has closed the descriptor then, and
  /// must not close it again, for it may be another file's.
  bool forget_listener() { return svr_sock_.exchange(INVALID_SOCKET) != INVALID_SOCKET; }

 private:
  bool process_and_close_socket(socket_t socket) override {
    HttpConnection connection(socket);
    try {
      if (is_private && !connection.is_of_own_user()) {
        throw UnreadableRequest(403, "this daemon belongs to another user: start one of your own with shakend");
      }
      const auto head_ended = [this, &connection](httplib::Request& request) {
        if (gate) {
          const auto refusal = gate({request.method, request.path, request.params, "", in_lower_case(request.headers)});
          if (refusal) throw UnreadableRequest(refusal->status, refusal->reason);
        }
        connection.head_ended(request);
        // A range may be asked for again and again in one request: its answer would be of any size.
        request.ranges.clear();
      };
      bool closed = false;
      for (std::size_t n = 1; svr_sock_ != INVALID_SOCKET && !closed && connection.next_request(); ++n) {
        const bool answered = process_request(connection, n >= keep_alive_max_count_, closed, head_ended);
        closed = closed || !answered || n >= keep_alive_max_count_ || !connection.request_ended();
      }
    } catch (const UnreadableRequest& problem) {
      connection.refuse(problem, headers);
    } catch (const std::exception&) {  // NOLINT(bugprone-empty-catch): no memory for an answer; the others go on
    }
    return true;
  }
};

}  // namespace

std::string Request::header(const std::string& name) const { return first_of(headers, name); }

std::string Request::parameter(const std::string& name) const { return first_of(query, name); }

struct HttpServer::Impl {
  Impl(std::filesystem::path socket_file, Handler handler) : socket(std::move(socket_file)) {
    set_up(std::move(handler));
    bind();
    start();
  }
  Impl(int wanted_port, Gate gate, Handler handler, const Headers& headers) {
    server.gate = std::move(gate);
    server.headers = headers;
    server.set_default_headers({headers.begin(), headers.end()});
    set_up(std::move(handler));
    bind(wanted_port);
    start();
  }

  void set_up(Handler handler) {
    const auto answer = [handler = std::move(handler)](const httplib::Request& request, std::string body,
                                                       httplib::Response& response) {
      put(handler({request.method, request.path, request.params, std::move(body), in_lower_case(request.headers)}),
          response);
    };
    const auto without_body = [answer](const httplib::Request& request, httplib::Response& response) {
      answer(request, "", response);
    };
    const auto with_body = [answer](const httplib::Request& request, httplib::Response& response,
                                    const httplib::ContentReader& content) {
      std::string body;
      // Without either header there is no body (RFC 7230, 3.3.3); cpp-httplib would wait for the end of the connection.
      const bool has_body = request.has_header("Content-Length") || request.has_header("Transfer-Encoding");
      const bool complete = !has_body || content([&](const char* data, std::size_t size) {
        body.append(data, size);
        return true;
      });
      if (complete) answer(request, std::move(body), response);
    };
    server.Get(".*", without_body);
    server.Options(".*", without_body);
    server.Post(".*", with_body);
    server.Put(".*", with_body);
    server.Patch(".*", with_body);
    server.Delete(".*", with_body);
    server.set_exception_handler([](const httplib::Request&, httplib::Response& response, std::exception_ptr problem) {
      try {
        std::rethrow_exception(std::move(problem));
      } catch (const UnreadableRequest& unreadable) {
        response.status = unreadable.status;
        response.set_content(error_body(unreadable.what()), "application/json");
      } catch (...) {  // out of memory: error handlers explain the rest
        response.status = 500;
      }
    });
    server.set_error_handler([](const httplib::Request&, httplib::Response& response) {
      if (response.body.empty()) response.set_content(error_body(explain(response.status)), "application/json");
    });

    server.set_keep_alive_timeout(HttpConnection::kIdle.count());  // what answers say of it
    server.new_task_queue = [this] { return new ThreadPerConnection([this] { failed = server.forget_listener(); }); };
  }

  void start() {
    listening = std::async(std::launch::async, [this] {
      try {
        server.listen_after_bind();
      } catch (...) {  // out of memory between two connections
        failed = server.forget_listener();
      }
    });
    // stop() before that would be lost; an accept() that fails at once ends it before it is seen
    const auto has_ended = [this] { return listening.wait_for(std::chrono::seconds(0)) == std::future_status::ready; };
    while (!server.is_running() && !has_ended()) std::this_thread::yield();
  }

  void bind() {
    if (socket.native().size() >= sizeof(sockaddr_un::sun_path)) {
      throw Failure(ExitCode::kFailed, "the path of the socket is too long for the system (" +
                                           std::to_string(socket.native().size()) + " of at most " +
                                           std::to_string(sizeof(sockaddr_un::sun_path) - 1) +
                                           " bytes): " + socket.string() + "; choose a shorter --root");
    }
    std::error_code error;
    std::filesystem::remove(socket, error);
    if (error) throw Failure(ExitCode::kFailed, "cannot remove " + socket.string() + ": " + error.message());
    int fd = -1;
    server.set_address_family(AF_UNIX);
    server.set_socket_options([&fd](int listener) { fd = listener; });
    if (!server.bind_to_port(socket.string(), kUnusedPort)) {
      throw Failure(ExitCode::kFailed, "cannot listen on " + socket.string() + ": " + std::strerror(errno));
    }
    ::chmod(socket.c_str(), 0600);
    ::listen(fd, kBacklog);
    ::stat(socket.c_str(), &file);
  }

  void bind(int wanted_port) {
    int fd = -1;
    server.is_private = false;
    server.set_tcp_nodelay(true);
    server.set_socket_options([&fd](int listener) {
      fd = listener;
      // Not SO_REUSEPORT, which cpp-httplib sets: another program could listen beside this one.
      const int yes = 1;
      setsockopt(listener, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
    });
    port = wanted_port;
    const bool bound = wanted_port == 0 ? (port = server.bind_to_any_port(kLoopback)) > 0
                                        : server.bind_to_port(kLoopback, wanted_port);
    if (!bound) {
      const int reason = errno;
      const std::string failure = "cannot listen on port " + std::to_string(wanted_port) + " of " + kLoopback + ": ";
      if (reason == EACCES) {
        throw Failure(ExitCode::kBadInput, failure + "ports below 1024 are root's; choose another, such as 8642");
      }
      throw Failure(ExitCode::kFailed, failure + std::strerror(reason) + "; choose another port");
    }
    ::listen(fd, kBacklog);
  }

  std::filesystem::path socket;  ///< empty with a port
  int port = 0;
  BoundedServer server;
  struct stat file {};  ///< of the socket
  bool closed = false;
  std::atomic<bool> failed{false};
  std::future<void> listening;
};

HttpServer::HttpServer(std::filesystem::path socket, Handler handler)
    : impl_(std::make_unique<Impl>(std::move(socket), std::move(handler))) {}

HttpServer::HttpServer(int port, Gate gate, Handler handler, const Headers& headers)
    : impl_(std::make_unique<Impl>(port, std::move(gate), std::move(handler), headers)) {}

HttpServer::~HttpServer() { close(); }

int HttpServer::port() const { return impl_->port; }

bool HttpServer::is_reachable() const {
  if (impl_->socket.empty()) return true;
  struct stat now {};
  return ::stat(impl_->socket.c_str(), &now) == 0 && now.st_dev == impl_->file.st_dev &&
         now.st_ino == impl_->file.st_ino;
}

bool HttpServer::has_failed() const { return impl_->failed; }

void HttpServer::close() {
  if (std::exchange(impl_->closed, true)) return;
  if (!impl_->failed) impl_->server.stop();
  if (impl_->socket.empty() || !is_reachable()) return;  // what stands there now is not ours
  std::error_code ignored;
  std::filesystem::remove(impl_->socket, ignored);
}

bool HttpServer::ended_within(std::chrono::milliseconds timeout) {
  return impl_->listening.wait_for(timeout) == std::future_status::ready;
}

}  // namespace shaken::http
