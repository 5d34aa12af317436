#include "web/site.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <numbers>
#include <system_error>
#include <utility>

#include "base/descriptor.h"
#include "base/files.h"
#include "base/paths.h"
#include "base/scratch_folder.h"
#include "base/text.h"
#include "client/starter_scene.h"
#include "web/json_reply.h"
#include "web/packed_frame.h"
#include "web/recorded_run.h"

namespace shaken::web {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using http::Reply;
using http::Request;

/// A stream ends before an answer may take no longer; a browser then asks again by itself.
constexpr std::chrono::seconds kStream{45};
/// Between two signs of life, by which a stream notices that its browser is gone.
constexpr std::chrono::seconds kHeartbeat{1};
/// Between two frames.
constexpr std::chrono::milliseconds kFrame{50};
/// In which a run that streams 5 frames a second or more sends one.
constexpr std::chrono::milliseconds kNextFrame{250};
constexpr std::size_t kPiece = std::size_t{1} << 20;  // of a file

std::string type_of(const fs::path& file) {
  const std::string suffix = file.extension().string();
  if (suffix == ".html") return "text/html; charset=utf-8";
  if (suffix == ".css") return "text/css; charset=utf-8";
  if (suffix == ".js") return "text/javascript; charset=utf-8";
  if (suffix == ".svg") return "image/svg+xml";
  if (suffix == ".png") return "image/png";
  if (suffix == ".pdf") return "application/pdf";
  if (suffix == ".mp4") return "video/mp4";
  if (suffix == ".webm") return "video/webm";
  return "application/octet-stream";
}

Reply file_reply(const fs::path& file) {
  Result<std::string> text = read_file(file);
  if (!text) return refusal(500, text.error().message);
  return {.status = 200, .body = std::move(*text), .type = type_of(file)};
}

Reply of_reader(Result<std::string> answer, const char* type) {
  if (!answer) return refusal(404, answer.error().message);
  return {.status = 200, .body = std::move(*answer), .type = type};
}

std::string event(const char* name, const std::string& data) {
  return std::string("event: ") + name + "\ndata: " + data + "\n\n";
}

/// A number, or null: JSON has neither infinities nor NaN.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json observables_json(const observables_t& m) {
  return {{"time_s", number(m.sim_time_s)},
          {"total_s", number(m.sim_time_total_s)},
          {"n_rods", m.n_rods},
          {"order", number(m.order)},
          {"order_running_mean", number(m.order_running_mean)},
          {"rms_speed_xy_mm_s", number(m.rms_speed_xy_mm_s)},
          {"rms_n_z", number(m.rms_n_z)},
          {"max_overlap_mm", number(m.max_overlap_mm)},
          {"sim_rate", number(m.sim_rate)},
          {"eta_s", number(m.eta_s)}};
}

Json defects_json(const defects_t& m) {
  Json list = Json::array();
  for (std::size_t i = 0; i < m.charge.size(); ++i) {
    list.push_back({number(m.x_mm[i]), number(m.y_mm[i]), number(m.charge[i]), number(m.direction_rad[i])});
  }
  return {{"time_s", number(m.sim_time_s)}, {"defects", list}};
}

/// The colours of rods and what chooses between them (base/palettes.h), evenly spaced along each scale: angles to the
/// director from -90 to 90 degrees, angles in the box over half a turn, n_z from -kFullTilt to kFullTilt; and those of
/// species, beside angles and alone.
Json palettes() {
  constexpr double kPi = std::numbers::pi;
  const auto scale = [](std::size_t steps, auto colour_at) {
    Json colours = Json::array();
    for (std::size_t i = 0; i < steps; ++i) colours.push_back(client::ink_of(colour_at(i)));
    return colours;
  };
  const auto part = [](std::size_t i, int of) { return static_cast<double>(i) / of; };
  return {{"layers", scale(73, [&](std::size_t i) { return layer_colour((part(i, 72) - 0.5) * kPi); })},
          {"wheel", scale(24, [&](std::size_t i) { return wheel_colour(part(i, 24) * kPi); })},
          {"tilt", scale(25, [&](std::size_t i) { return diverging_colour(2 * part(i, 24) - 1); })},
          {"species", scale(3, name_colour)},
          {"others", scale(3, species_colour)},
          {"full_tilt", kFullTilt},
          {"order_of_layers", kOrderOfLayers},
          {"order_margin", kOrderMargin},
          {"floor", client::ink_of(client::kFloorTone)},
          {"wall", client::ink_of(client::kWallTone)}};
}

/// Scenes to begin from, [{"name", "text"}]: that of `shaken init`, and the files in the folder `configs`.
Json examples(const std::filesystem::path& configs) {
  std::vector<std::filesystem::path> files;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(configs, error)) {
    if (entry.path().extension() == ".json") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  Json scenes = Json::array({{{"name", "a small box"}, {"text", client::kStarterScene}}});
  for (const auto& file : files) {
    if (const auto text = read_file(file)) scenes.push_back({{"name", file.stem().string()}, {"text", *text}});
  }
  return scenes;
}

/// The pieces of an open file. Throws where one cannot be read: what has come so far is not the file.
struct FilePieces {
  Descriptor file;
  std::optional<std::string> operator()() const {
    std::string piece(kPiece, '\0');
    ssize_t n = 0;
    do n = read(file.value(), piece.data(), piece.size());
    while (n < 0 && errno == EINTR);
    if (n < 0) throw std::system_error(errno, std::generic_category(), "a file that is sent");
    if (n == 0) return std::nullopt;
    piece.resize(static_cast<std::size_t>(n));
    return piece;
  }
};

}  // namespace

Site::Site(SiteSetup setup)
    : setup_(std::move(setup)),
      daemon_(setup_.root),
      looks_(setup_.root, std::chrono::seconds(2)),
      reader_(setup_.root / "runs", [this] { return is_closing_.load(); }) {
  if (setup_.bus) live_.emplace(std::move(setup_.bus));
  queue_.emplace(looks_, [this](const std::set<std::string>& running) {
    if (live_) live_->keep(running);
  });
}

Reply Site::answer(const Request& request) {
  try {
    return routed(request);
  } catch (const std::exception& problem) {
    return refusal(500, problem.what());
  }
}

Reply Site::routed(const Request& request) {
  const std::vector<std::string> parts = split(request.path, '/');
  const std::string first = parts.empty() ? "" : parts.front();
  const bool reads = request.method == "GET" || request.method == "HEAD";
  if (first == "v1" && (reads || request.method == "POST")) return daemon_.ask(request);
  if (parts == std::vector<std::string>{"tickets"} && request.method == "POST") return ticket(request);
  if (parts == std::vector<std::string>{"cost"} && request.method == "POST") return cost(request);
  if (!reads) return refusal(405, request.path + " can only be read");
  if (parts.empty()) return page_file("index.html");
  if (first == "page" && parts.size() == 2) {
    const bool is_name = fs::path(parts[1]).filename() == parts[1] && parts[1] != "index.html";
    std::error_code unknown;
    const bool is_there = is_name && fs::is_regular_file(setup_.page / parts[1], unknown);
    return is_there ? page_file(parts[1]) : refusal(404, "the page has no file " + parts[1]);
  }
  if (parts == std::vector<std::string>{"chart.js"}) return file_reply(setup_.chart_library);
  if (parts == std::vector<std::string>{"palettes.json"}) return json_reply(palettes());
  if (parts == std::vector<std::string>{"examples"}) return json_reply({{"examples", examples(shipped_configs())}});
  if (first == "tickets" && parts.size() == 2) {
    const std::optional<Request> meant = tickets_.take(parts[1]);
    return meant ? routed(*meant) : refusal(404, "this ticket has been used, or is over a minute old");
  }
  const std::string run = first == "live" ? request.parameter("run") : parts.size() > 1 ? parts[1] : "";
  if (first == "live" || first == "runs") {
    const bool is_queue_only = first == "live" && run.empty();
    if (!is_queue_only && !is_id(run)) return refusal(404, "no run has the id " + run);
    if (parts == std::vector<std::string>{"live"}) return events(run);
    if (first == "runs") return of_run(run, {parts.begin() + 2, parts.end()}, request);
  }
  return refusal(404, "no such path: " + request.path + "; see docs/web.md");
}

Reply Site::page_file(const std::string& name) const { return file_reply(setup_.page / name); }

Reply Site::events(const std::string& run) {
  struct Progress {
    std::int64_t queue = 0;
    LiveSeen run;
    bool has_begun = false;
    Clock::time_point next_frame, end;
  };
  const bool is_live = !run.empty() && live_;
  Progress begin;
  begin.next_frame = Clock::now();
  begin.end = begin.next_frame + kStream;
  Reply reply{.status = 200, .body = "", .type = "text/event-stream"};
  reply.stream = [this, run, is_live, progress = begin]() mutable -> std::optional<std::string> {
    if (is_closing_ || Clock::now() > progress.end) return std::nullopt;
    std::string events;
    if (is_live && !std::exchange(progress.has_begun, true)) {
      const client::History order = live_->order(run);
      events += event("order", text_of({{"time_s", order.times()}, {"order", order.values()}}));
    }
    if (is_live) {
      std::this_thread::sleep_until(progress.next_frame);
      progress.next_frame = Clock::now() + kFrame;
      const LiveNews news = live_->wait(run, progress.run, kHeartbeat);
      if (news.observables) events += event("observables", text_of(observables_json(*news.observables)));
      if (news.defects) events += event("defects", text_of(defects_json(*news.defects)));
      if (news.frame) events += event("frame", base64(packed(*news.frame)));
    }
    const auto queue = queue_->wait(progress.queue, is_live ? std::chrono::milliseconds(0) : kHeartbeat);
    if (queue) events += event("queue", *queue);
    return events.empty() ? ":\n\n" : events;
  };
  return reply;
}

Reply Site::ticket(const Request& request) {
  const std::vector<std::string> parts = split(request.parameter("path"), '/');
  if (parts.size() < 3 || parts[0] != "runs") return refusal(400, "tickets are for files and pictures of runs");
  std::multimap<std::string, std::string> query = request.query;
  query.erase("path");
  return json_reply({{"ticket", tickets_.give(request.parameter("path"), query)}});
}

Reply Site::of_run(const std::string& run, const std::vector<std::string>& rest, const Request& request) {
  const std::string what = rest.empty() ? "" : rest.front();
  if (what == "frames" && rest.size() == 1) {
    return of_reader(reader_.ask(run, {"frames"}), "application/json");
  }
  if (what == "frames" && rest.size() == 2) {
    if (!number_in<std::size_t>(rest[1])) return refusal(404, rest[1] + " is no number of a frame");
    return of_reader(reader_.ask(run, {"frame", rest[1]}), "application/octet-stream");
  }
  if (what == "newest" && rest.size() == 1) return newest(run);
  if (what == "order" && rest.size() == 1) return of_reader(reader_.ask(run, {"order"}), "application/json");
  if (what == "path" && rest.size() == 1) {
    const std::string rod = request.parameter("rod"), frame = request.parameter("frame");
    if (!number_in<std::size_t>(rod) || !(frame == "last" || number_in<std::size_t>(frame)))
      return refusal(404, "expected ?rod=I&frame=K");
    return of_reader(reader_.ask(run, {"path", rod, frame}), "application/json");
  }
  if (what == "curves" && rest.size() == 1) return curves(run, request);
  if (what == "picture" && rest.size() == 1) {
    return picture(run, request);
  }
  if (what == "files" && rest.size() == 1) {
    Json files = Json::array();
    for (const FileEntry& entry : RecordedRun(directory(run)).files())
      files.push_back({{"name", entry.name}, {"bytes", entry.size}});
    return json_reply({{"directory", directory(run).string()}, {"files", files}});
  }
  if (what == "files" && rest.size() == 2) return file(run, rest[1]);
  return refusal(404, "no such path: " + request.path + "; see docs/web.md");
}

Reply Site::newest(const std::string& run) {
  if (const auto frame = live_ ? live_->next_frame(run, kNextFrame) : nullptr) {
    return {.status = 200, .body = packed(*frame), .type = "application/octet-stream"};
  }
  return of_reader(reader_.ask(run, {"frame", "last"}), "application/octet-stream");
}

Reply Site::curves(const std::string& run, const Request& request) {
  std::vector<std::string> question{"curves"};
  const auto [begin, end] = request.query.equal_range("of");
  for (auto asked = begin; asked != end; ++asked) question.push_back(asked->second);
  return of_reader(reader_.ask(run, question), "application/json");
}

Reply Site::file(const std::string& run, const std::string& name) const {
  const auto files = RecordedRun(directory(run)).files();
  const bool is_there =
      std::any_of(files.begin(), files.end(), [&](const FileEntry& entry) { return entry.name == name; });
  if (!is_there) return refusal(404, "run " + run + " has no file " + name);
  const fs::path path = directory(run) / name;
  auto opened =
      std::make_shared<FilePieces>(FilePieces{Descriptor(open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC))});
  if (!opened->file) return refusal(404, "cannot read " + path.string());
  Reply reply{.status = 200, .body = "", .type = type_of(name)};
  // What a run directory holds is saved, never shown as a page of this origin. Its names are of letters, digits, . and
  // -.
  reply.headers.emplace_back("Content-Disposition", "attachment; filename=\"" + run + "-" + name + "\"");
  reply.stream = [opened] { return (*opened)(); };
  return reply;
}

Reply Site::picture(const std::string& run, const Request& request) {
  const std::string frame = request.parameter("frame"), style = request.parameter("style"),
                    size = request.parameter("size");
  const std::string format = request.parameter("format").empty() ? "png" : request.parameter("format");
  if (format != "png" && format != "svg" && format != "pdf") return refusal(400, "format is one of png, svg, pdf");
  const auto frames = reader_.ask(run, {"frames"});
  if (!frames) return refusal(404, frames.error().message);
  const std::optional<std::size_t> index = number_in<std::size_t>(frame);
  if (const Json found = Json::parse(*frames); !index || *index >= found.at("n").get<std::size_t>())
    return refusal(404, found.value("reason", "no frame '" + frame + "'"));
  const std::unique_lock lock(drawing_, std::try_to_lock);
  if (!lock) return refusal(429, "another picture is being drawn: try again");
  const ScratchFolder folder;
  const fs::path file = folder.path() / ("picture." + format);
  std::vector<std::string> command{setup_.renderer.string(),
                                   "picture",
                                   directory(run).string(),
                                   "--frame",
                                   std::to_string(*index),
                                   "-o",
                                   file.string()};
  if (!style.empty()) command.push_back("--style=" + style);
  if (!size.empty()) command.push_back("--size=" + size);
  const Captured drawn =
      run_captured(command, CaptureLimits{.time = setup_.drawing, .stop = [this] { return is_closing_.load(); }});
  if (drawn.cut_short) {
    return refusal(504, "shaken-render has not drawn the picture within " +
                            std::to_string(setup_.drawing.count() / 1000) + " s and was ended");
  }
  if (drawn.exit_code != 0) return refusal(500, "shaken-render: " + drawn.output);
  Reply reply = file_reply(file);
  reply.headers.emplace_back("Content-Disposition",
                             "attachment; filename=\"" + run + "-" + std::to_string(*index) + "." + format + "\"");
  return reply;
}

Reply Site::cost(const Request& request) {
  const Json body = Json::parse(request.body, nullptr, false);
  const bool is_whole = body.is_object() && body.contains("text") && body["text"].is_string() &&
                        (!body.contains("replicas") || body["replicas"].is_number_integer());
  if (!is_whole) return refusal(400, R"(expected {"text": a scene or sweep, "replicas": a number, if any})");
  const std::unique_lock lock(estimating_, std::try_to_lock);
  if (!lock) return refusal(429, "the cost of another scene is being estimated: try again");
  const ScratchFolder folder;
  const std::filesystem::path scene = folder.path() / "scene.json";
  if (const auto written = write_file(scene, body["text"].get<std::string>()); !written) {
    return refusal(507, written.error().message);
  }
  std::vector<std::string> command{setup_.client.string(), "submit", scene.string(), "--dry-run", "--json"};
  if (body.contains("replicas")) command.push_back("--replicas=" + std::to_string(body["replicas"].get<int>()));
  const Captured captured =
      run_captured(command, CaptureLimits{.time = setup_.estimating, .stop = [this] { return is_closing_.load(); }});
  if (captured.cut_short) {
    return refusal(504, "the cost is not known: the rods were not placed and stepped within " +
                            std::to_string(setup_.estimating.count() / 1000) + " s");
  }
  if (captured.exit_code != 0) return refusal(422, captured.output);
  const Json answer = Json::parse(captured.output, nullptr, false);
  if (!answer.is_object() || !answer.contains("estimate")) return refusal(500, "shaken: " + captured.output);
  return json_reply(answer["estimate"]);
}

}  // namespace shaken::web
