// SPDX-License-Identifier: Apache-2.0
#include "common/credentials/credentials.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/base/files.h"
#include "tests/support/temporary_folder.h"

namespace shoal {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr fs::perms kOwnersFile = fs::perms::owner_read | fs::perms::owner_write;

class CredentialsTest : public ::testing::Test {
 protected:
  CredentialsTest() { Create(folder_, ValidForDays(2)); }
  static void Create(const fs::path& folder, const Validity& validity) {
    const std::vector<RoleRights> roles{{"actor", {"transitions"}, {"credit"}},
                                        {"learner", {"weights"}, {}}};
    CreateCredentials(folder, roles, validity);
  }
  static std::string Mistake(const fs::path& folder, std::time_t now = std::time(nullptr)) {
    try {
      CheckCredentials(folder, "actor", now);
    } catch (const Error& e) {
      EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos);
      return e.what();
    }
    return "no error";
  }

  TemporaryFolder parent_;
  const fs::path folder_ = parent_.path() / "secure";
};

TEST_F(CredentialsTest, ServeEachRoleAndAreTheOwnersAlone) {
  CheckCredentials(folder_, "actor", std::time(nullptr));
  CheckCredentials(folder_, "learner", std::time(nullptr));
  EXPECT_EQ(fs::status(folder_).permissions(), fs::perms::owner_all);
  for (const auto& file : fs::directory_iterator(folder_)) {
    EXPECT_EQ(file.status().permissions(), kOwnersFile) << file.path();
  }
}

TEST_F(CredentialsTest, PermitARoleItsTopicsAndNoOthers) {
  const std::string actor = ReadFile(folder_ / "actor.p7s");
  EXPECT_THAT(actor, AllOf(HasSubstr("CN=shoal-actor"),
                           HasSubstr("<publish><topics><topic>transitions</topic></topics>"),
                           HasSubstr("<subscribe><topics><topic>credit</topic></topics>"),
                           HasSubstr("<default>DENY</default>")));
  EXPECT_EQ(actor.find("weights"), std::string::npos);
  EXPECT_EQ(ReadFile(folder_ / "learner.p7s").find("<subscribe>"), std::string::npos);
}

TEST_F(CredentialsTest, ATopicThatTheyDoNotPermitIsNamedWithTheFile) {
  const auto mistake = [&](const RoleRights& rights) -> std::string {
    try {
      CheckRights(folder_, rights);
    } catch (const Error& e) {
      return e.what();
    }
    return "no error";
  };
  EXPECT_EQ(mistake({"actor", {"transitions"}, {"credit"}}), "no error");
  EXPECT_EQ(mistake({"learner", {}, {}}), "no error");
  EXPECT_THAT(mistake({"actor", {"transitions", "slots"}, {}}),
              AllOf(HasSubstr("actor.p7s"), HasSubstr("publish topic 'slots'"),
                    HasSubstr("shoal secure init")));
  EXPECT_THAT(mistake({"actor", {}, {"transitions"}}), HasSubstr("subscribe topic 'transitions'"));
  EXPECT_THAT(mistake({"learner", {}, {"credit"}}), HasSubstr("subscribe topic 'credit'"));
}

TEST_F(CredentialsTest, AnExistingFolderIsNotOverwritten) {
  const std::string before = ReadFile(folder_ / "ca.pem");
  try {
    Create(folder_, ValidForDays(2));
    FAIL() << "overwritten";
  } catch (const Error& e) {
    EXPECT_EQ(e.exit_code(), 2);
    EXPECT_THAT(e.what(), HasSubstr(folder_.string()));
  }
  EXPECT_EQ(ReadFile(folder_ / "ca.pem"), before);
}

TEST_F(CredentialsTest, OutsideTheirTimeAreRefusedWithTheDate) {
  const std::time_t now = std::time(nullptr);
  const fs::path old = parent_.path() / "old";
  Create(old, {.from = 0, .until = 24 * 60 * 60});
  EXPECT_THAT(Mistake(old), AllOf(HasSubstr("ca.pem"), HasSubstr("expired on 1970-01-02")));
  EXPECT_THAT(Mistake(folder_, now + 3 * 24 * 60 * 60), HasSubstr("expired"));
  EXPECT_THAT(Mistake(folder_, now - 3 * 24 * 60 * 60), HasSubstr("clock"));
}

TEST_F(CredentialsTest, AMissingOrBrokenFileIsNamed) {
  for (const char* name : {"ca.pem", "governance.p7s", "actor.pem", "actor.key", "actor.p7s"}) {
    const fs::path copy = parent_.path() / name;
    fs::copy(folder_, copy);
    fs::remove(copy / name);
    EXPECT_THAT(Mistake(copy), HasSubstr((copy / name).string()));
    WriteFileAtomically(copy / name, "");
    EXPECT_THAT(Mistake(copy), HasSubstr((copy / name).string()));
  }
  EXPECT_THAT(Mistake("/absent"), HasSubstr("/absent/ca.pem"));
}

TEST_F(CredentialsTest, ACertificateOfAnotherAuthorityOrWithAnotherKeyIsRefused) {
  const fs::path other = parent_.path() / "other", mixed = parent_.path() / "mixed";
  Create(other, ValidForDays(2));
  fs::copy(folder_, mixed);
  fs::copy(other / "actor.pem", mixed / "actor.pem", fs::copy_options::overwrite_existing);
  EXPECT_THAT(Mistake(mixed), AllOf(HasSubstr("actor.pem"), HasSubstr("not made by")));
  fs::copy(folder_ / "actor.pem", mixed / "actor.pem", fs::copy_options::overwrite_existing);
  fs::copy(other / "actor.key", mixed / "actor.key", fs::copy_options::overwrite_existing);
  EXPECT_THAT(Mistake(mixed), AllOf(HasSubstr("actor.key"), HasSubstr("not the key")));
}

// The DDS library would refuse them as well, but as another process on the port.
TEST_F(CredentialsTest, ADocumentOfAnotherAuthorityOrOneThatWasAlteredIsRefused) {
  const fs::path other = parent_.path() / "other";
  Create(other, ValidForDays(2));
  for (const char* name : {"governance.p7s", "actor.p7s"}) {
    const fs::path foreign = parent_.path() / (std::string("foreign-") + name),
                   altered = parent_.path() / (std::string("altered-") + name);
    fs::copy(folder_, foreign);
    fs::copy(other / name, foreign / name, fs::copy_options::overwrite_existing);
    EXPECT_THAT(Mistake(foreign), AllOf(HasSubstr((foreign / name).string()), HasSubstr("ca.pem")));
    fs::copy(folder_, altered);
    std::string text = ReadFile(folder_ / name);
    const size_t at = text.find("<dds");
    ASSERT_LT(at, text.size());
    ++text[at + 1];
    WriteFileAtomically(altered / name, text);
    EXPECT_THAT(Mistake(altered), HasSubstr((altered / name).string()));
    WriteFileAtomically(altered / name, "neither signed nor sealed");
    EXPECT_THAT(Mistake(altered), HasSubstr((altered / name).string()));
  }
}

}  // namespace
}  // namespace shoal
