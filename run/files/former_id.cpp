// SPDX-License-Identifier: MIT
#include "run/files/former_id.h"

#include <nlohmann/json.hpp>

#include "base/files.h"
#include "run/files/checkpoint_file.h"
#include "scene/canonical.h"

namespace shaken::run {

Result<void> renew_id(const RunDirectory& directory, const scene::RunPlan& plan) {
  const std::string former = scene::scene_hash(plan);
  const std::string id = scene::run_id(plan);
  for (const auto& file : directory.checkpoints()) {
    const Result<Checkpoint> checkpoint = read_checkpoint(file, former);
    if (!checkpoint) continue;
    if (auto done = write_file_atomically(file, as_bytes(id, *checkpoint)); !done) return done.error();
  }
  const Result<std::string> text = read_file(directory.summary());
  if (!text) return {};
  auto summary = nlohmann::ordered_json::parse(*text, nullptr, false);
  if (!summary.is_object() || !summary.contains("run_id") || summary["run_id"] != former) return {};
  summary["run_id"] = id;
  return write_file_atomically(directory.summary(), summary.dump(2) + "\n");
}

}  // namespace shaken::run
