#include "tests/e2e/run_command.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>

namespace shaken::test {

using std::chrono::steady_clock;

namespace {
constexpr auto kPoll = std::chrono::milliseconds(5);
}

Process::Process(const std::vector<std::string>& command, std::filesystem::path output) : output_(std::move(output)) {
  std::vector<char*> arguments;
  for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  std::filesystem::remove(output_);  // nobody shall read what an earlier process printed
  pid_ = fork();
  if (pid_ < 0) throw std::runtime_error("fork failed");
  if (pid_ == 0) {
    const int fd = open(output_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    dup2(fd, STDOUT_FILENO);
    dup2(fd, STDERR_FILENO);
    execv(arguments[0], arguments.data());
    _exit(127);
  }
}

Process::~Process() {
  if (poll()) return;
  kill(pid_, SIGKILL);
  waitpid(pid_, nullptr, 0);
}

bool Process::poll() {
  if (!ended_ && waitpid(pid_, &status_, WNOHANG) == pid_) ended_ = true;
  return ended_;
}

void Process::signal(int number) const { kill(pid_, number); }

int Process::wait(std::chrono::seconds limit) {
  const auto until = steady_clock::now() + limit;
  while (!poll()) {
    if (steady_clock::now() > until) return -1;
    std::this_thread::sleep_for(kPoll);
  }
  return WIFEXITED(status_) ? WEXITSTATUS(status_) : 128 + WTERMSIG(status_);
}

std::string Process::output() const {
  std::stringstream text;
  text << std::ifstream(output_).rdbuf();
  return text.str();
}

bool Process::wait_for(const std::string& text, std::chrono::seconds limit) {
  const auto until = steady_clock::now() + limit;
  for (;;) {
    const bool ended = poll();
    if (output().find(text) != std::string::npos) return true;
    if (ended || steady_clock::now() > until) return false;
    std::this_thread::sleep_for(kPoll);
  }
}

Finished run_command(const std::vector<std::string>& command, std::chrono::seconds limit) {
  const ScratchFolder directory;
  Process process(command, directory.path() / "output");
  const int code = process.wait(limit);
  return {code, process.output()};
}

}  // namespace shaken::test
