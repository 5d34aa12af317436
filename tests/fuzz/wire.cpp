// Payloads of LCM messages, each byte string as every type; the messages then go where a viewer puts them.
#include "client/live/live.h"
#include "client/live/live_rods.h"
#include "client/watch/rod_cells.h"
#include "proto/codec.h"
#include "proto/frame_codec.h"
#include "tests/fuzz/fuzz_target.h"

using namespace shaken;

namespace {

template <class T>
std::optional<T> decoded(std::span<const std::uint8_t> payload) {
  auto message = proto::decode<T>(payload);
  if (message) {
    const auto again = proto::encode(*message);
    fuzz::promise(std::equal(again.begin(), again.end(), payload.begin(), payload.end()),
                  "a message that is taken is what was sent");
  }
  return message;
}

/// Every jobs' messages are of this job.
constexpr const char* kJob = "0123456789abcdef";

client::Json job() {
  return {{"id", kJob},
          {"sweep", "s1"},
          {"state", "running"},
          {"ended", false},
          {"reason", ""},
          {"label", "x"},
          {"replica", 1},
          {"attempt", 1},
          {"pid", 1},
          {"progress", nullptr},
          {"created_utime", 0},
          {"started_utime", 0},
          {"finished_utime", 0},
          {"parameters", client::Json::object()}};
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span payload(data, size);
  static client::LiveJobs jobs;
  static proto::FrameAssembler frames(kJob);
  static client::LiveRods rods;
  static int n_used = 0;
  if (n_used++ % 1000 == 0) {
    jobs = {};
    jobs.note_api(job());
    frames = proto::FrameAssembler(kJob);
    rods = {};
    rods.select(kJob);
  }
  const auto note = [](auto message, auto& to) {
    if (!message) return;
    message->job_id = kJob;
    to.note(*message);
  };
  (void)decoded<status_t>(payload);
  note(decoded<frame_static_t>(payload), rods);
  note(decoded<posts_t>(payload), rods);
  note(decoded<sizes_t>(payload), rods);
  if (const auto message = decoded<job_t>(payload)) (void)jobs.contradicts(*message);
  note(decoded<observables_t>(payload), jobs);
  note(decoded<defects_t>(payload), jobs);
  if (auto message = decoded<frame_t>(payload)) {
    (void)proto::decode_chunk(*message);
    message->job_id = kJob;
    if (const auto frame = frames.add(*message)) (void)proto::encode_frame(*frame);
    rods.note(*message);
    if (const auto shown = rods.newest()) {
      client::CellGrid grid(20, 10);
      client::draw_rods(*shown, {}, {}, {}, {0, 0, 20, 10}, grid);
    }
  }
  (void)jobs.jobs().front().fraction();
  return 0;
}
