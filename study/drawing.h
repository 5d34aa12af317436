// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string_view>

#include "client/console.h"
#include "study/selection.h"

namespace shaken::study {

/// Draws figures into a folder from the runs that are done, and collects the films.
class FigureMaker {
 public:
  /// Each file is named on stdout once it is there, unless `quiet`.
  FigureMaker(const Selection& selection, std::filesystem::path runs_folder, std::filesystem::path out, bool quiet,
              client::Console& console);

  /// False if it could not be drawn, which is told.
  bool draw(const PaperFigure& figure);
  /// [{"figure", "file"}] of all that was drawn.
  const Json& made() const { return made_; }

 private:
  /// S1.mp4, S2.mp4, ... in the order of the sweep, and a picture of the end of each.
  bool collect_films();
  /// A picture of the run's last frame in OUT/pictures, drawn once; an empty path if there is none.
  std::filesystem::path snapshot(const FinishedRun& run) const;
  void tell(std::string_view id, const std::filesystem::path& file);

  const Selection& selection_;
  std::filesystem::path runs_folder_, out_;
  bool quiet_;
  client::Console& console_;
  Json made_ = Json::array();
};

}  // namespace shaken::study
