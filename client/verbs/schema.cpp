// SPDX-License-Identifier: MIT
#include "scene/schema.h"

#include <fmt/format.h>

#include "client/live/json.h"
#include "client/verbs/verbs.h"
#include "render/style_file.h"

namespace shaken::client {
namespace {

class PrintSchema : public Verb {
 public:
  VerbInfo info() const override {
    return {"schema", kPrepareGroup, "Print the JSON Schema of scenes, sweeps or styles, for editors",
            "  shaken schema > scene.schema.json\n"
            "  shaken schema sweep > sweep.schema.json   of sweeps and scenes\n"
            "  shaken schema style > style.schema.json   of styles of pictures\n"
            "\nA file that names its schema, as the one that `shaken init` writes does, is completed and checked by an "
            "editor. `shaken validate` checks more than a schema can say."};
  }

  void declare(Arguments& arguments) override {
    arguments.optional("KIND", kind_, "scene, sweep or style; scene if left out", {"scene", "sweep", "style"});
  }

  ExitCode run(const Context& context) override {
    if (kind_ != "scene" && kind_ != "sweep" && kind_ != "style") {
      throw Failure(ExitCode::kBadInput, fmt::format("\"{}\" is neither scene nor sweep nor style", kind_));
    }
    context.console.out << json_text(kind_ == "scene"   ? scene::scene_schema()
                                     : kind_ == "sweep" ? scene::sweep_schema()
                                                        : render::style_schema());
    return ExitCode::kOk;
  }

 private:
  std::string kind_ = "scene";
};

}  // namespace

std::unique_ptr<Verb> make_schema() { return std::make_unique<PrintSchema>(); }

}  // namespace shaken::client
