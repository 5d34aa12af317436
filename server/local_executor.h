#pragma once

#include <filesystem>

#include "server/executor.h"

namespace shaken::server {

/// Workers as child processes, each in a process group of its own. They get SIGTERM when the thread that started them
/// ends: workers never outlive their daemon for longer than a checkpoint takes.
class LocalExecutor final : public Executor {
 public:
  explicit LocalExecutor(std::filesystem::path program) : program_(std::move(program)) {}

  Result<int> start(const Launch& launch) override;
  WorkerReport poll(int pid) override;
  void stop(int pid) override;
  void kill(int pid) override;

 private:
  std::filesystem::path program_;
};

}  // namespace shaken::server
