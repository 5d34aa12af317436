#include "web/served_page.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>

#include "base/scratch_folder.h"

namespace shaken::web {
namespace {

TEST(ServedPage, IsServedOnceAndItsAddressIsItsOwners) {
  const ScratchFolder root;
  {
    auto page = ServedPage::claim(root.path());
    ASSERT_TRUE(page) << page.error().message;
    EXPECT_FALSE(ServedPage::claim(root.path())) << "a second one";
    EXPECT_FALSE(served_address(root.path())) << "not known yet";
    ASSERT_TRUE(page->announce("http://127.0.0.1:8642/#token=abc"));
    EXPECT_EQ(served_address(root.path()), "http://127.0.0.1:8642/#token=abc");
    struct stat status {};
    ASSERT_EQ(stat((root / "web.address").c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 0777, 0600u) << "nobody else may read the token";
  }
  EXPECT_FALSE(served_address(root.path())) << "it goes with the page";
  EXPECT_TRUE(ServedPage::claim(root.path()));
}

TEST(ServedPage, AnAddressElsewhereIsNotBelieved) {
  const ScratchFolder root;
  std::ofstream(root / "web.address") << "http://evil.example/#token=abc\n";
  EXPECT_FALSE(served_address(root.path()));
}

}  // namespace
}  // namespace shaken::web
