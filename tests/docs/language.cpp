// SPDX-License-Identifier: Apache-2.0
#include "tests/docs/language.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>

#include "common/base/files.h"

namespace shoal {
namespace {

namespace fs = std::filesystem;

constexpr size_t kColumns = 100;

constexpr std::array<std::string_view, 6> kOpenings = {"What", "Of",   "Where",
                                                       "As",   "With", "Whoever"};

constexpr std::array<std::string_view, 17> kPhrases = {
    "nobody",    "somebody",  "whoever",  "is told",    "are told",  "was told",
    "were told", "be told",   "goes by",  "go by",      "lies in",   "lie in",
    "lay in",    "stands at", "stand at", "the former", "the latter"};

// What comments cite of other projects, of the build, or as an example.
const std::set<std::string> kFilesOfOthers = {
    // Stable-Baselines3, dm_control, PyTorch, CPython, TensorFlow, ONNX, Cyclone DDS, dygraphs
    "common/policies.py", "common/save_util.py", "common/torch_layers.py",
    "common/vec_env/vec_normalize.py", "ppo.py", "sac/policies.py", "td3/policies.py",
    "mujoco/engine.py", "rl/control.py", "torch/_utils.py", "torch/serialization.py",
    "Lib/pickletools.py", "tensorflow/core/lib/io/record_writer.h", "docs/IR.md",
    "docs/Operators.md", "onnx/onnx.proto", "ddsi_cdrstream.c", "dygraph.min.js",
    // made by CMake, or by `shoal new`
    "models.cpp", "task/goal.cpp", "task/physics.cpp",
    // examples
    "FILE.py", "FOLDER/goal.cpp", "NAME_fuzz.cpp", "docs/a.md", "docs/b.md", "own_tusk.md"};

constexpr std::array<std::string_view, 9> kFileEndings = {".md", ".h",  ".cpp",   ".c", ".cmake",
                                                          ".sh", ".py", ".proto", ".js"};

bool IsPage(const std::string& file) { return file.ends_with(".md"); }

bool IsText(const fs::path& file) {
  static const std::set<std::string> kExtensions = {".c",  ".cmake", ".cpp",   ".css", ".h",
                                                    ".js", ".md",    ".proto", ".py",  ".sh"};
  static const std::set<std::string> kNames = {"CMakeLists.txt", "run"};
  const std::string path = file.string();
  // The rules, their tests and their page quote forbidden words.
  return !path.starts_with("tests/docs/language") && path.find("plain-english") == path.npos &&
         (kExtensions.contains(file.extension()) || kNames.contains(file.filename()));
}

bool IsWordCharacter(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

bool IsPathCharacter(char c) { return IsWordCharacter(c) || c == '.' || c == '/' || c == '-'; }

size_t Columns(std::string_view line) {
  // Bytes that go on with a character of UTF-8 take no column.
  return size_t(std::ranges::count_if(line, [](char c) { return (c & 0xC0) != 0x80; }));
}

std::string_view Trimmed(std::string_view text) {
  const size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::string Shown(std::string_view text) {
  text = Trimmed(text);
  return text.size() <= 100 ? std::string(text) : std::string(text.substr(0, 97)) + "...";
}

// Reads a file line by line.
class Reader {
 public:
  Reader(const std::string& file, const std::set<std::string>& tree)
      : is_page_(IsPage(file)),
        marker_(file.ends_with(".cmake") || file.ends_with(".txt") || file.ends_with(".py") ||
                        file.ends_with(".sh") || file == "run"
                    ? "#"
                    : "//"),
        tree_(tree) {}

  void Take(std::string_view line) {
    ++number_;
    if (is_page_ && Trimmed(line).starts_with("```")) {
      in_code_ = !in_code_;
      return;
    }
    if (in_code_) return;
    const std::optional<std::string_view> comment = CommentOf(line);
    if (is_page_) {
      CheckWidth(line);
      CheckReferences(line);
    } else if (comment) {
      CheckReferences(*comment);
    }
    CheckOpening(line, comment);
    Append(is_page_ ? Trimmed(line) : Trimmed(StartsWithComment(line) ? *comment : line));
  }

  std::vector<LanguageFault> Finish() {
    CheckPhrases();
    std::ranges::stable_sort(faults_, {}, &LanguageFault::line);
    return std::move(faults_);
  }

 private:
  bool StartsWithComment(std::string_view line) const {
    return !is_page_ && Trimmed(line).starts_with(marker_);
  }

  // The text after a comment's marker. A comment begins its line, or follows code and two spaces.
  std::optional<std::string_view> CommentOf(std::string_view line) const {
    if (is_page_) return std::nullopt;
    if (StartsWithComment(line)) return Trimmed(line).substr(marker_.size());
    const size_t at = line.find("  " + marker_ + " ");
    if (at == std::string_view::npos) return std::nullopt;
    return line.substr(at + 2 + marker_.size());
  }

  void CheckOpening(std::string_view line, std::optional<std::string_view> comment) {
    const std::string_view text = comment ? Trimmed(*comment) : std::string_view();
    const bool opens = comment && !(StartsWithComment(line) && continues_);
    // The licence line and an empty one end a paragraph.
    continues_ = StartsWithComment(line) && !text.empty() && !text.starts_with("SPDX-") &&
                 !text.starts_with("!");
    if (!opens) return;
    const std::string_view word = text.substr(0, text.find_first_of(" ,"));
    if (std::ranges::find(kOpenings, word) != kOpenings.end()) Report("opening", number_, text);
  }

  void CheckWidth(std::string_view line) {
    const std::string_view text = Trimmed(line);
    if (Columns(line) <= kColumns || text.starts_with('|') || text.starts_with('<')) return;
    // It can wrap where a space has a word before it, be it one of a list's items.
    const size_t word = text.find_first_not_of("-*0123456789. #");
    const size_t space = text.find(' ', word);
    if (space < kColumns) Report("width", number_, fmt::format("{} columns", Columns(line)));
  }

  void CheckReferences(std::string_view text) {
    for (size_t i = 0; i < text.size();) {
      size_t end = i;
      while (end < text.size() && IsPathCharacter(text[end])) ++end;
      const bool behind_address = i > 0 && (text[i - 1] == ':' || text[i - 1] == '@');
      if (end > i && !behind_address) CheckReference(std::string(text.substr(i, end - i)));
      i = std::max(end, i + 1);
    }
  }

  void CheckReference(std::string path) {
    while (path.ends_with('.')) path.pop_back();
    while (path.starts_with("../") || path.starts_with("./")) path.erase(0, path.find('/') + 1);
    const bool is_file = std::ranges::any_of(kFileEndings, [&](std::string_view ending) {
      return path.size() > ending.size() && path.ends_with(ending) &&
             IsWordCharacter(path[path.size() - ending.size() - 1]);
    });
    if (!is_file || !std::isalpha(static_cast<unsigned char>(path[0])) ||
        path.find("//") != path.npos || kFilesOfOthers.contains(path)) {
      return;
    }
    const bool is_there = std::ranges::any_of(
        tree_, [&](const std::string& file) { return file == path || file.ends_with("/" + path); });
    if (!is_there) Report("reference", number_, path);
  }

  // Appends to the text in which phrases are looked for, so that one may be broken over two lines.
  void Append(std::string_view line) {
    starts_.push_back(flat_.size());
    numbers_.push_back(number_);
    std::ranges::transform(line, std::back_inserter(flat_),
                           [](unsigned char c) { return char(std::tolower(c)); });
    flat_ += ' ';
  }

  void CheckPhrases() {
    for (const std::string_view phrase : kPhrases) {
      for (size_t at = flat_.find(phrase); at != std::string::npos;
           at = flat_.find(phrase, at + 1)) {
        const char after = flat_[at + phrase.size()];
        if ((at > 0 && IsWordCharacter(flat_[at - 1])) || IsWordCharacter(after)) continue;
        const size_t line = size_t(std::ranges::upper_bound(starts_, at) - starts_.begin()) - 1;
        Report("phrase", numbers_[line], fmt::format("\"{}\"", phrase));
      }
    }
  }

  void Report(std::string rule, int line, std::string_view text) {
    faults_.push_back({.rule = std::move(rule), .line = line, .text = Shown(text)});
  }

  const bool is_page_;
  const std::string marker_;
  const std::set<std::string>& tree_;
  int number_ = 0;
  bool in_code_ = false, continues_ = false;
  std::string flat_;
  std::vector<size_t> starts_;  // of each line in flat_
  std::vector<int> numbers_;
  std::vector<LanguageFault> faults_;
};

// Built, recorded or generated.
bool IsLeftOut(const std::string& folder) {
  static const std::set<std::string> kFolders = {".cache",
                                                 ".git",
                                                 "build",
                                                 "runs",
                                                 "docs/results/experiments",
                                                 "docs/results/runs",
                                                 "experiments",
                                                 "tests/fuzz/corpus",
                                                 "tests/golden"};
  return kFolders.contains(folder);
}

}  // namespace

std::vector<LanguageFault> LanguageFaultsOf(const std::string& file, std::string_view text,
                                            const std::set<std::string>& tree) {
  Reader reader(file, tree);
  while (!text.empty()) {
    const size_t end = std::min(text.find('\n'), text.size());
    reader.Take(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return reader.Finish();
}

std::set<std::string> FilesOf(const fs::path& root) {
  std::set<std::string> files;
  for (auto it = fs::recursive_directory_iterator(root); it != fs::end(it); ++it) {
    const std::string path = it->path().lexically_relative(root);
    if (it->is_directory()) {
      if (IsLeftOut(path)) it.disable_recursion_pending();
    } else if (it->is_regular_file()) {
      files.insert(path);
    }
  }
  return files;
}

std::map<std::string, std::vector<LanguageFault>> FindLanguageFaults(const fs::path& root) {
  const std::set<std::string> tree = FilesOf(root);
  std::map<std::string, std::vector<LanguageFault>> faults;
  for (const std::string& file : tree) {
    if (!IsText(file)) continue;
    std::vector<LanguageFault> found = LanguageFaultsOf(file, ReadFile(root / file), tree);
    if (!found.empty()) faults[file] = std::move(found);
  }
  return faults;
}

}  // namespace shoal
