#include "scene/schema.h"

#include <fmt/format.h>

#include "client/catalogue.h"
#include "client/live/json.h"
#include "client/verbs/verbs.h"
#include "render/style_file.h"

namespace shaken::client {
namespace {

class PrintSchema : public Verb {
 public:
  VerbInfo info() const override {
    return {"schema", kPrepareGroup, "Print the JSON Schema of scenes, sweeps or styles, or the catalogue",
            "  shaken schema > scene.schema.json\n"
            "  shaken schema sweep > sweep.schema.json   of sweeps and scenes\n"
            "  shaken schema style > style.schema.json   of styles of pictures\n"
            "  shaken schema catalogue                   every key, observable, array, number, unit, ...\n"
            "\nA file that names its schema, as the one that `shaken init` writes does, is completed and checked by an "
            "editor. `shaken validate` checks more than a schema can say."};
  }

  void declare(Arguments& arguments) override {
    arguments.optional("KIND", kind_, "scene, sweep, style or catalogue; scene if left out",
                       "scene|sweep|style|catalogue");
  }

  ExitCode run(const Context& context) override {
    context.console.out << text();
    return ExitCode::kOk;
  }

 private:
  std::string text() const {
    if (kind_ == "scene") return json_text(scene::scene_schema());
    if (kind_ == "sweep") return json_text(scene::sweep_schema());
    if (kind_ == "style") return json_text(render::style_schema());
    if (kind_ == "catalogue") return catalogue();
    throw Failure(ExitCode::kBadInput, fmt::format("\"{}\" is neither scene, sweep, style nor catalogue", kind_));
  }

  std::string kind_ = "scene";
};

}  // namespace

std::unique_ptr<Verb> make_schema() { return std::make_unique<PrintSchema>(); }

}  // namespace shaken::client
