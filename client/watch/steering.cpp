#include "client/watch/steering.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace shaken::client {
namespace {

constexpr double kZoomStep = 1.25;
constexpr double kLargestZoom = 32;
constexpr double kMoveStep = 0.1;  // of what is seen

void move(RodView& view, int right, int up, const Vec2& period) {
  const auto moved = [&](double place, int steps, bool is_periodic) {
    place += steps * kMoveStep / view.zoom;
    return is_periodic ? place - std::floor(place) : std::clamp(place, 0.0, 1.0);
  };
  view.x = moved(view.x, right, period.x() > 0);
  view.y = moved(view.y, up, period.y() > 0);
}

void zoom_by(RodView& view, double factor) {
  view.zoom = std::clamp(view.zoom * factor, 1.0, kLargestZoom);
  if (view.zoom < std::sqrt(kZoomStep)) view = {};  // the whole box, as it was
}

/// The job `steps` further round the list; the first one if the present one is not in it.
std::string neighbour(const std::string& job, std::span<const std::string> jobs, int steps) {
  if (jobs.empty()) return job;
  const auto place = std::find(jobs.begin(), jobs.end(), job);
  if (place == jobs.end()) return jobs.front();
  const auto n = std::ssize(jobs);
  return jobs[static_cast<std::size_t>((place - jobs.begin() + steps + n) % n)];
}

void steer_by_letter(Steering& state, char letter, std::span<const std::string> jobs) {
  if (letter == 'q') state.quit = true;
  if (letter == ' ') state.paused = !state.paused;
  if (letter == '+' || letter == '=') zoom_by(state.view, kZoomStep);
  if (letter == '-') zoom_by(state.view, 1 / kZoomStep);
  if (letter == '0') state.view = {};
  if (letter == 'c') state.colouring = static_cast<Colouring>((static_cast<int>(state.colouring) + 1) % 5);
  if (letter == 'b') state.grain = state.grain == Grain::kBraille ? Grain::kBlocks : Grain::kBraille;
  if (letter == 'd') state.shows_defects = !state.shows_defects;
  if (letter == 'o') state.numbers = !state.numbers;
  if (letter == 'n' || letter == '\t') state.job = neighbour(state.job, jobs, 1);
  if (letter == 'p') state.job = neighbour(state.job, jobs, -1);
  if (letter == '?' || letter == 'h') state.help = true;
  if (letter == '\f') state.redraw = true;
  if (letter == '\x1a') state.suspend = true;
  const bool is_number = letter >= '1' && letter <= '9' && letter - '1' < std::ssize(jobs);
  if (is_number) state.job = jobs[static_cast<std::size_t>(letter - '1')];
}

}  // namespace

Steering steered(Steering state, const Key& key, std::span<const std::string> jobs, const Vec2& period) {
  // Any key puts the help away, and does nothing else; but one still leaves by q.
  if (state.help && !(key.kind == Key::Kind::kCharacter && key.character == 'q')) {
    state.help = false;
    return state;
  }
  if (key.kind == Key::Kind::kUp) move(state.view, 0, 1, period);
  if (key.kind == Key::Kind::kDown) move(state.view, 0, -1, period);
  if (key.kind == Key::Kind::kLeft) move(state.view, -1, 0, period);
  if (key.kind == Key::Kind::kRight) move(state.view, 1, 0, period);
  if (key.kind == Key::Kind::kBackTab) state.job = neighbour(state.job, jobs, -1);
  if (key.kind == Key::Kind::kCharacter) steer_by_letter(state, key.character, jobs);
  return state;
}

}  // namespace shaken::client
