#include "render/program/runs.h"

#include <fmt/format.h>

#include <cmath>
#include <iostream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "base/failure.h"
#include "base/text.h"
#include "render/headline.h"

namespace shaken::render {

Runs::Runs(const Options& options) : options_(options) {
  std::string wrong;
  for (const std::string& name : options.sources) {
    Result<TrajectorySource> source = TrajectorySource::open(name);
    if (source) {
      sources_.push_back(std::move(*source));
    } else {
      wrong += (wrong.empty() ? "" : "\n") + source.error().message;
    }
  }
  if (!wrong.empty()) throw Failure(ExitCode::kBadInput, wrong);
  if (options.labels.size() > sources_.size()) {
    throw Failure(ExitCode::kBadInput,
                  fmt::format("{} headlines (--label) for {} runs", options.labels.size(), sources_.size()));
  }
  if (are_several() && options.out.empty()) throw Failure(ExitCode::kBadInput, "several runs need -o FILE");
}

std::string Runs::out_or(const char* name) const {
  return options_.out.empty() ? (sources_.front().file().parent_path() / name).string() : options_.out;
}

void Runs::prepare(const PictureStyle& style, double first, double last) {
  for (TrajectorySource& source : sources_) {
    if (!style.followed_defect) break;
    const std::size_t from = value_or_fail(source.nearest_frame(first)), to = value_or_fail(source.nearest_frame(last));
    done_or_fail(source.follow(*style.followed_defect, from, to), ExitCode::kBadInput);
  }
  if (style.inset != Inset::kSweep) return;
  if (options_.sweep.empty()) {
    throw Failure(ExitCode::kBadInput,
                  "an inset of the sweep takes its points from --sweep: `shaken picture` and `shaken movie` give it "
                  "where --inset sweep is on their command line");
  }
  places_ = value_or_fail(sweep_places(options_.sweep, options_.sources.size()), ExitCode::kBadInput);
}

Result<RodPicture> Runs::joint_picture(const PictureStyle& style,
                                       const std::function<Result<RodPicture>(TrajectorySource&)>& picture_of) {
  std::vector<RodPicture> pictures;
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    Result<RodPicture> picture = picture_of(sources_[i]);
    if (!picture) return picture;
    check_picture(style, *picture);
    picture->captions.sweep = places_.map;
    if (places_.map) picture->captions.sweep_point = places_.here[i];
    pictures.push_back(std::move(*picture));
  }
  std::vector<Captions*> runs;
  for (RodPicture& picture : pictures) runs.push_back(&picture.captions);
  name_runs(runs);
  for (std::size_t i = 0; i < pictures.size(); ++i) set_label(options_, i, pictures[i].captions);
  RodPicture first = std::move(pictures.front());
  for (std::size_t i = 1; i < pictures.size(); ++i) {
    for (const auto& [key, value] : pictures[i].captions.notes) {
      if (key != "Software") first.captions.notes.emplace_back(fmt::format("{} ({})", key, i + 1), value);
    }
  }
  first.beside.assign(std::make_move_iterator(pictures.begin() + 1), std::make_move_iterator(pictures.end()));
  return first;
}

void check_picture(const PictureStyle& style, const RodPicture& picture) {
  if (style.followed && static_cast<std::size_t>(*style.followed) >= picture.n_rods()) {
    throw Failure(ExitCode::kBadInput, fmt::format("there is no rod {}: they are numbered from 0 to {}",
                                                   *style.followed, static_cast<std::ptrdiff_t>(picture.n_rods()) - 1));
  }
}

void set_label(const Options& options, std::size_t run, Captions& captions) {
  if (run >= options.labels.size() || options.labels[run].empty()) return;
  if (captions.subtitle.empty()) captions.subtitle = captions.label;
  captions.label = headline(printable(options.labels[run]));
}

void report(const Options& options, const std::string& path, std::size_t n_frames, const PictureStyle& style,
            double seconds) {
  if (path == "-") return;  // stdout has the frames
  if (!options.json) {
    std::cout << path << "\n";
    return;
  }
  const nlohmann::ordered_json said = {{"path", path},
                                       {"frames", n_frames},
                                       {"width_px", style.width},
                                       {"height_px", style.height},
                                       {"seconds", std::round(seconds * 1000) / 1000}};
  std::cout << said.dump() << "\n";
}

}  // namespace shaken::render
