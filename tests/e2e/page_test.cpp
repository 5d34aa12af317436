// The page of `shakend --web` in a real browser.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <fstream>

#include "tests/e2e/run_command.h"
#include "tests/support/effort.h"
#include "tests/support/good.h"

namespace shaken::test {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

/// The address in what shaken-web has printed.
std::string address_in(const std::string& output) {
  const std::size_t begin = output.find("http://127.0.0.1:");
  return begin == std::string::npos ? "" : output.substr(begin, output.find('\n', begin) - begin);
}

TEST(Page, IsUsedInABrowser) {
  if (!at_night()) GTEST_SKIP() << "a browser: minutes";
  const bool live = std::getenv("SHAKEN_OWN_NETWORK") != nullptr;
  const ScratchFolder folder;
  const std::string root = (folder.path() / "root").string();
  std::vector<std::string> command{program("shakend"), "--root", root, "--slots", "2", "--web", "--web-port", "0"};
  if (!live) command.emplace_back("--no-lcm");
  Process daemon(command, folder.path() / "daemon.log");
  ASSERT_TRUE(daemon.wait_for("#token=", 20s)) << daemon.output();
  const std::string address = address_in(daemon.output());

  std::ofstream(folder.path() / "waits.json")
      << R"({"rods": {"length": 3, "area_fraction": 0.5}, "box": {"side": "20 mm"},
    "time": {"measure": "20000 s"}, "stream": {"rate": 10}})";
  const std::string scene = (folder.path() / "waits.json").string();
  ASSERT_EQ(run_command({program("shaken"), "--root", root, "submit", scene, "--name", "waits"}).code, 0);
  ASSERT_EQ(run_command({program("shaken"), "--root", root, "hold", "waits"}).code, 0);

  const std::string screenshot = SHAKEN_BINARY_DIR "/page-test.png";
  std::vector<std::string> use{"/usr/bin/python3", SHAKEN_PAGE_SCRIPT, address, screenshot};
  if (live) use.emplace_back("--live");
  const Finished used = run_command(use, 520s);
  EXPECT_EQ(used.code, 0) << used.output << "\nsee " << screenshot << "\n" << daemon.output();

  // `shaken web` finds the one that runs: same token, same daemon.
  const std::string port = address.substr(address.rfind(':') + 1, address.find("/#") - address.rfind(':') - 1);
  EXPECT_THAT(said_with(0, run_command({program("shaken"), "--root", root, "web", "--port", port})),
              HasSubstr("open " + address));

  daemon.signal(SIGTERM);
  EXPECT_EQ(daemon.wait(20s), 0) << daemon.output();
}

TEST(Page, IsStartedAgainWhereItEnds) {
  const ScratchFolder folder;
  const std::string root = (folder.path() / "root").string();
  Process daemon({program("shakend"), "--root", root, "--no-lcm", "--web", "--web-port", "0"}, folder.path() / "log");
  ASSERT_TRUE(daemon.wait_for("#token=", 20s)) << daemon.output();
  const std::string first = address_in(daemon.output());
  ASSERT_EQ(run_command({"/usr/bin/pkill", "-KILL", "-P", std::to_string(daemon.pid()), "shaken-web"}).code, 0);
  ASSERT_TRUE(daemon.wait_for("shaken-web was ended by signal 9", 20s)) << daemon.output();
  const auto is_up_again = [&] {
    const std::string output = daemon.output();
    return address_in(output.substr(output.find("was ended by signal 9"))) != "";
  };
  for (int i = 0; i < 200 && !is_up_again(); ++i) usleep(100'000);
  EXPECT_TRUE(is_up_again()) << daemon.output();
  daemon.signal(SIGTERM);
  EXPECT_EQ(daemon.wait(20s), 0) << daemon.output();
  EXPECT_NE(run_command({"/usr/bin/pgrep", "-f", "shaken-web --root " + root}).code, 0) << "it ends with the daemon";
}

// Another program may have taken the port meanwhile.
TEST(Page, ThatCannotHaveItsPortBackSaysSoAndTriesAgain) {
  const ScratchFolder folder;
  setenv("LD_PRELOAD", SHAKEN_FAILING_CALLS, 1);
  const std::string orders = "accept:" + std::to_string(ENOMEM) + ":1,bind:" + std::to_string(EADDRINUSE) + ":2";
  setenv("SHAKEN_CALL_FAILS", orders.c_str(), 1);
  Process page({program("shaken-web"), "--root", folder.path().string(), "--no-lcm", "--port", "0"},
               folder.path() / "log");
  unsetenv("LD_PRELOAD");
  unsetenv("SHAKEN_CALL_FAILS");
  ASSERT_TRUE(page.wait_for("#token=", 20s)) << page.output();
  const std::string address = address_in(page.output());
  const std::size_t port = std::string("http://127.0.0.1:").size();
  const std::string connect = "exec 3<>/dev/tcp/127.0.0.1/" + address.substr(port, address.find("/#") - port);
  run_command({"/bin/bash", "-c", connect});
  EXPECT_TRUE(page.wait_for("cannot listen on port", 20s)) << page.output();
  EXPECT_TRUE(page.wait_for("listening anew", 20s)) << page.output();
  EXPECT_EQ(run_command({"/bin/bash", "-c", connect}).code, 0);
  page.signal(SIGTERM);
  EXPECT_EQ(page.wait(20s), 0) << page.output();
}

TEST(Page, NeedsADaemon) {
  const ScratchFolder folder;
  EXPECT_THAT(said_with(3, run_command({program("shaken"), "--root", folder.path().string(), "web"})),
              HasSubstr("start shakend"));
}

}  // namespace
}  // namespace shaken::test
