// shaken-render: pictures and movies of recorded and of running jobs, without a display.
#include <fmt/format.h>

#include <string>

#include "base/program.h"
#include "render/colourings.h"
#include "render/program/films.h"
#include "render/program/options.h"
#include "render/program/pictures.h"
#include "run/files/version.h"

namespace {

std::string footer() {
  std::string colours;
  for (const auto& each : shaken::render::colourings()) colours += fmt::format("  {:<9} {}\n", each.name, each.doc);
  return "Colours (-c):\n"
         "  auto      layers where there is order and no defect is marked, else angle\n" +
         colours +
         "Examples:\n"
         "  shaken-render picture runs/first                           last frame -> runs/first/picture.png\n"
         "  shaken-render picture runs/first -o fig3.png --time 12.5s --colour tilt --size 1600x900\n"
         "  shaken-render picture runs/first -o fig4.pdf --style director --theme print\n"
         "  shaken-render movie runs/first                             -> runs/first/movie.mp4\n"
         "  shaken-render movie runs/first -o m.gif --from 10s --to 20s --speed 0.5 --size 640x360\n"
         "  shaken-render movie runs/a runs/b -o two.mp4 --label 0.45 --label 0.80     side by side, with one clock\n"
         "  shaken-render movie runs/first -o - --bare --size 720x720 | ffmpeg -f rawvideo -pix_fmt rgb24 -s 720x720 "
         "...\n"
         "  shaken-render style defects > mine.json                    a style file to begin with\n"
         "  shaken-render live 1f0c -o now.png                         a running job, from LCM\n"
         "Exit codes: 0 done, 1 failed, 2 bad input, 130 interrupted by Ctrl-C.";
}

}  // namespace

int main(int argc, char** argv) {
  using namespace shaken::render;
  Options options;
  shaken::Program app("shaken-render", "Pictures and movies of shaken rods, without a display.", footer().c_str());
  app.set_version_flag("--version", std::string("shaken-render ") + shaken::run::version());
  app.require_subcommand(1);
  const CLI::App* picture = app.add_subcommand("picture", "One frame of a recorded run as a PNG, SVG or PDF");
  declare_picture(*app.get_subcommand("picture"), options);
  const CLI::App* film = app.add_subcommand("movie", "A recorded run as a film");
  declare_film(*app.get_subcommand("movie"), options);
  const CLI::App* live = app.add_subcommand("live", "The present state of a running job as a picture, from LCM");
  declare_live(*app.get_subcommand("live"), options);
  app.add_subcommand("style", "Lists the presets, or prints one as a style file")
      ->add_option("name", options.preset, "Preset");
  return app.run(argc, argv, [&] {
    if (picture->parsed()) {
      make_picture(options);
    } else if (film->parsed()) {
      make_film(options);
    } else if (live->parsed()) {
      make_live_picture(options);
    } else {
      print_styles(options);
    }
    return shaken::ExitCode::kOk;
  });
}
