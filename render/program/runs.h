#pragma once

#include <functional>
#include <string>
#include <vector>

#include "render/headline.h"
#include "render/program/options.h"
#include "render/sources.h"

namespace shaken::render {

/// The recorded runs that the command line names, drawn as one picture. What is wrong is a Failure.
class Runs {
 public:
  explicit Runs(const Options& options);

  TrajectorySource& first() { return sources_.front(); }
  std::vector<TrajectorySource>& all() { return sources_; }
  bool are_several() const { return sources_.size() > 1; }
  /// `name` beside the first run's trajectory, unless the command line says where.
  std::string out_or(const char* name) const;

  /// Looks up what the style needs besides frames, which may be of the times from `first` to `last` [s].
  void prepare(const PictureStyle& style, double first, double last);
  /// `picture_of(run)` of each run, those of further ones beside the first.
  Result<RodPicture> joint_picture(const PictureStyle& style,
                                   const std::function<Result<RodPicture>(TrajectorySource&)>& picture_of);

 private:
  const Options& options_;
  std::vector<TrajectorySource> sources_;
  SweepPlaces places_;  ///< where the runs are in their sweep; nothing where the style does not ask
};

/// Fails unless the rods have what the style asks of them.
void check_picture(const PictureStyle& style, const RodPicture& picture);

/// The headline that the command line gives a run, above what was its own.
void set_label(const Options& options, std::size_t run, Captions& captions);

/// Says on stdout what was written: the path, or all of it as JSON.
void report(const Options& options, const std::string& path, std::size_t n_frames, const PictureStyle& style,
            double seconds);

}  // namespace shaken::render
