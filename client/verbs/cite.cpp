#include <fmt/format.h>

#include "client/verbs/verbs.h"
#include "run/files/version.h"

namespace shaken::client {
namespace {

class Cite : public Verb {
 public:
  VerbInfo info() const override {
    return {"cite", kHelpGroup, "Print how to cite Shaken and the paper whose system it simulates, as BibTeX",
            "  shaken cite >> references.bib\n"
            "\nPlease name the version. The scene of a run, with its seed, is in its scene.json: with it anybody can "
            "compute the run again, bit for bit."};
  }
  void declare(Arguments&) override {}

  ExitCode run(const Context& context) override {
    context.console.out << fmt::format(R"(@software{{shaken,
  author  = {{{{The Shaken developers}}}},
  title   = {{Shaken: a simulator of shaken granular nematics}},
  version = {{{}}},
}}
@article{{sharma2024phases,
  author  = {{Sharma, Abhishek and Soni, Harsh}},
  title   = {{Phases and correlations in active nematic granular systems}},
  journal = {{Soft Matter}},
  year    = {{2024}},
  volume  = {{20}},
  number  = {{33}},
  pages   = {{6608--6617}},
  doi     = {{10.1039/d4sm00667d}},
}}
)",
                                       run::version());
    return ExitCode::kOk;
  }
};

}  // namespace

std::unique_ptr<Verb> make_cite() { return std::make_unique<Cite>(); }

}  // namespace shaken::client
