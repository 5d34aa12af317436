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
  switch (letter) {
    case 'q':
      state.quit = true;
      break;
    case ' ':
      state.paused = !state.paused;
      break;
    case '+':
    case '=':
      zoom_by(state.view, kZoomStep);
      break;
    case '-':
      zoom_by(state.view, 1 / kZoomStep);
      break;
    case '0':
      state.view = {};
      break;
    case 'c':
      state.colouring = static_cast<Colouring>((static_cast<int>(state.colouring) + 1) % 5);
      break;
    case 'b':
      state.grain = state.grain == Grain::kBraille ? Grain::kBlocks : Grain::kBraille;
      break;
    case 'd':
      state.shows_defects = !state.shows_defects;
      break;
    case 'o':
      state.numbers = !state.numbers;
      break;
    case 'n':
    case '\t':
      state.job = neighbour(state.job, jobs, 1);
      break;
    case 'p':
      state.job = neighbour(state.job, jobs, -1);
      break;
    case '?':
    case 'h':
      state.help = true;
      break;
    case '\f':
      state.redraw = true;
      break;
    case '\x1a':
      state.suspend = true;
      break;
    default:
      if (letter >= '1' && letter <= '9' && letter - '1' < std::ssize(jobs)) {
        state.job = jobs[static_cast<std::size_t>(letter - '1')];
      }
  }
}

}  // namespace

Steering steered(Steering state, const Key& key, std::span<const std::string> jobs, const Vec2& period) {
  // Any key puts the help away, and does nothing else; but one still leaves by q.
  if (state.help && !(key.kind == Key::Kind::kCharacter && key.character == 'q')) {
    state.help = false;
    return state;
  }
  switch (key.kind) {
    case Key::Kind::kUp:
      move(state.view, 0, 1, period);
      break;
    case Key::Kind::kDown:
      move(state.view, 0, -1, period);
      break;
    case Key::Kind::kLeft:
      move(state.view, -1, 0, period);
      break;
    case Key::Kind::kRight:
      move(state.view, 1, 0, period);
      break;
    case Key::Kind::kBackTab:
      state.job = neighbour(state.job, jobs, -1);
      break;
    case Key::Kind::kEscape:
      break;
    case Key::Kind::kCharacter:
      steer_by_letter(state, key.character, jobs);
      break;
  }
  return state;
}

}  // namespace shaken::client
