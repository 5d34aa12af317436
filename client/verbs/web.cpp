#include "base/process.h"
#include "client/verbs/verbs.h"

namespace shaken::client {
namespace {

class Web : public Verb {
 public:
  VerbInfo info() const override {
    return {"web", kControlGroup, "Live in a browser: queue, phase diagram, rods, curves, files",
            "  shaken web                    prints the address to open; serves it until Ctrl-C\n"
            "  shaken web --port 9000        at another port of this machine\n"
            "  shakend --web                 the daemon does it beside its work; `shaken web` prints its address then"};
  }

  void declare(Arguments& arguments) override {
    arguments.option("--port", port_, "N", "Of 127.0.0.1; 8642 if left out, 0: any that is free");
    arguments.option("--lcm-url", lcm_url_, "URL", "The bus; the daemon's if left out");
  }

  ExitCode run(const Context& context) override {
    std::vector<std::string> command{sibling_program("shaken-web").string(), "--root", context.root().string()};
    if (!port_.empty()) command.push_back("--port=" + port_);
    if (!lcm_url_.empty()) command.push_back("--lcm-url=" + lcm_url_);
    become(command);
  }

 private:
  std::string port_, lcm_url_;
};

}  // namespace

std::unique_ptr<Verb> make_web() { return std::make_unique<Web>(); }

}  // namespace shaken::client
