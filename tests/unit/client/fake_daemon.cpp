#include "tests/unit/client/fake_daemon.h"

#include <httplib.h>

#include <thread>

namespace shaken::client {

struct FakeDaemon::Server {
  httplib::Server http;
  std::thread thread;
};

FakeDaemon::FakeDaemon(const std::filesystem::path& root) : server_(std::make_unique<Server>()) {
  const auto answer = [this](const httplib::Request& request, httplib::Response& response) {
    std::unique_lock lock(mutex_);
    const std::string line = request.method + " " + request.target;
    requests_.push_back({line, request.body});
    const auto found = answers_.find(line);
    if (found == answers_.end()) {
      response.status = 404;
      response.set_content(R"({"error": "no such thing: )" + line + "\"}", "application/json");
      return;
    }
    std::vector<Answer>& answers = found->second;
    response.status = answers.front().status;
    response.set_content(answers.front().body, "application/json");
    const std::chrono::milliseconds delay = answers.front().delay;
    if (answers.size() > 1) answers.erase(answers.begin());
    lock.unlock();
    std::this_thread::sleep_for(delay);
  };
  server_->http.Get(".*", answer);
  server_->http.Post(".*", answer);
  server_->http.set_address_family(AF_UNIX);
  const std::string socket = (root / "shakend.sock").string();
  server_->thread = std::thread([this, socket] { server_->http.listen(socket.c_str(), 80); });
  while (!server_->http.is_running()) std::this_thread::yield();
}

FakeDaemon::~FakeDaemon() {
  server_->http.stop();
  server_->thread.join();
}

void FakeDaemon::on(const std::string& line, std::vector<Answer> answers) {
  const std::lock_guard lock(mutex_);
  answers_[line] = std::move(answers);
}

std::vector<FakeDaemon::Request> FakeDaemon::requests() const {
  const std::lock_guard lock(mutex_);
  return requests_;
}

}  // namespace shaken::client
