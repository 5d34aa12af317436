// An LCM subscriber such as a user might write: plain lcm and the types that lcm-gen makes, nothing of Shaken's own
// code. usage: lcm_recorder URL > messages.jsonl; ends on SIGTERM.
#include <csignal>
#include <iostream>
#include <lcm/lcm-cpp.hpp>
#include <nlohmann/json.hpp>
#include <shaken/defects_t.hpp>
#include <shaken/frame_static_t.hpp>
#include <shaken/frame_t.hpp>
#include <shaken/job_t.hpp>
#include <shaken/observables_t.hpp>
#include <shaken/status_t.hpp>

namespace {

volatile std::sig_atomic_t stop = 0;

using Json = nlohmann::json;

Json fields(const shaken::status_t& m) { return {{"pid", m.pid}, {"n_slots", m.n_slots}, {"root", m.root}}; }
Json fields(const shaken::job_t& m) { return {{"job", m.job_id}, {"state", m.state}, {"progress", m.progress}}; }
Json fields(const shaken::observables_t& m) { return {{"job", m.job_id}, {"order", m.order}, {"n_rods", m.n_rods}}; }
Json fields(const shaken::frame_static_t& m) {
  return {{"job", m.job_id}, {"n_rods", m.n_rods}, {"box_mm", {m.box_x_mm, m.box_y_mm}}, {"n_beads", m.n_beads}};
}
Json fields(const shaken::frame_t& m) {
  return {{"job", m.job_id},  {"tick", m.tick},     {"box_mm", {m.box_x_mm, m.box_y_mm}},
          {"order", m.order}, {"n_rods", m.n_rods}, {"n_chunks", m.n_chunks},
          {"x", m.x},         {"y", m.y},           {"heading", m.heading},
          {"n_z", m.n_z}};
}
Json fields(const shaken::defects_t& m) { return {{"job", m.job_id}, {"charge", m.charge}}; }

struct Recorder {
  template <class T>
  void print(const lcm::ReceiveBuffer*, const std::string& channel, const T* message) {
    Json line = fields(*message);
    line["channel"] = channel;
    line["utime"] = message->utime;
    line["sequence"] = message->sequence;
    std::cout << line.dump() << std::endl;
  }
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  lcm::LCM bus(argv[1]);
  if (!bus.good()) return 1;
  Recorder recorder;
  bus.subscribe("SHAKEN_STATUS", &Recorder::print<shaken::status_t>, &recorder)->setQueueCapacity(1000);
  bus.subscribe("SHAKEN_JOB", &Recorder::print<shaken::job_t>, &recorder)->setQueueCapacity(1000);
  bus.subscribe("SHAKEN_OBSERVABLES", &Recorder::print<shaken::observables_t>, &recorder)->setQueueCapacity(1000);
  bus.subscribe("SHAKEN_FRAME_STATIC", &Recorder::print<shaken::frame_static_t>, &recorder)->setQueueCapacity(1000);
  bus.subscribe("SHAKEN_FRAME", &Recorder::print<shaken::frame_t>, &recorder)->setQueueCapacity(1000);
  bus.subscribe("SHAKEN_DEFECTS", &Recorder::print<shaken::defects_t>, &recorder)->setQueueCapacity(1000);
  std::signal(SIGTERM, [](int) { stop = 1; });
  std::cout << "{\"channel\": \"ready\"}" << std::endl;
  while (stop == 0) bus.handleTimeout(100);
  return 0;
}
