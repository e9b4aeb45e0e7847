#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Reads declarations of every kind, and plants changes in a small library that check_api has to name."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

import check_api
import declarations

HEADER = """// SPDX-License-Identifier: Apache-2.0
#pragma once
// struct InComment {};
#include "saccade/core/other.hpp"
namespace saccade {
class Forward;
enum class ForwardEnum : int;
template <class T>
class ForwardTemplate;
inline constexpr char kText[]{"struct InString { };"};
constexpr double kFirst{1.0}, kSecond = 2.0;  // two
constexpr std::array<std::pair<int, char>, 2> kPairs{{{1, '{'}, {2, '"'}}};
extern const std::function<void(int)> kCall;
enum class Errc : std::uint8_t { one, two };
/// A class with members and a friend.
template <class T = std::vector<int>>
class [[nodiscard]] Result final : public Base<T> {
 public:
  using Inner = int;
  struct Nested { int x{0}; };
  friend bool operator==(const Result&, const Result&) { return true; }
  friend void hidden(Result& r) { r = {}; }
  void member() const { if (true) { call(); } }
};
struct alignas(16) Lane { float x[4]; };
union Bits { int i; float f; };
[[nodiscard]] inline Status validate(const Region& region = Region{{1, 2}}) noexcept(true) { return {}; }
[[nodiscard]] Result<std::vector<std::pair<int, int>>> find(int x, std::function<bool(int)> test = [](int) { return true; });
template <int kLevel, class Visit>
SACCADE_HD auto walk(Visit&& visit) -> decltype(visit(0)) { return visit(kLevel); }
template <std::floating_point T>
  requires(sizeof(T) == 4)
T half(T x) { return x > T{0} ? x / 2 : x; }
template <class T>
  requires requires(T t) { t + t; }
T twice(T x) { return x + x; }
inline const Lane kChosen = is(1) ? Lane{1} : Lane{2};
template <class T>
concept Number = requires(T t) { t + t; };
template <class T>
using Vec = std::vector<T>;
using Call = std::function<void(int)>;
using other::Imported;
typedef int (*Handler)(int);
bool operator<(const Lane& a, const Lane& b);
Lane operator+(const Lane& a, const Lane& b);
std::ostream& operator<<(std::ostream& out, const Lane& lane);
double operator""_deg(long double degrees);
template <>
struct Result<void> : Base<void> { int y; };
inline Result<int>::Result(int x) : a_{x}, b_{2} { c_ = 3; }
void after_constructor(int x);
inline bool Result<int>::operator==(const Result& other) const { return a_ == other.a_; }
struct Result<int>::Hidden { int z; };
static_assert(sizeof(Lane) == 16);
extern template class Result<float>;
namespace internal { void helper(); }
namespace ray_detail { constexpr int kHelper{3}; }
namespace { int anonymous{0}; }
namespace tsdf { struct Float3 { float x; }; }
}  // namespace saccade
namespace saccade::arm { using Frame = int; }
template <>
struct std::hash<saccade::Lane> { int operator()(const saccade::Lane&) const; };
namespace std { struct NotOurs { int x; }; }
struct Global { int x; };
#define SACCADE_TWICE(x) \\
  { (x); {(x);
"""
NAMES = {
    "kText": "constant", "kFirst": "constant", "kSecond": "constant", "kPairs": "constant", "kCall": "constant",
    "Errc": "enum", "Result": "class", "Lane": "struct", "Bits": "union", "validate": "function", "find": "function",
    "walk": "function", "half": "function", "twice": "function", "kChosen": "constant",
    "after_constructor": "function", "Number": "concept", "Vec": "alias", "Call": "alias", "Imported": "alias",
    "Handler": "alias", "operator<": "function", "operator+": "function", "operator<<": "function",
    'operator""_deg': "function", "tsdf::Float3": "struct", "arm::Frame": "alias", "SACCADE_TWICE": "macro"}


def library():
    return {
        "lib/saccade/core/CMakeLists.txt": "saccade_room(core SOURCES a.cpp)\n",
        "lib/saccade/core/a.hpp": "namespace saccade { struct A {}; void f(int); void f(double); }\n",
        "lib/saccade/core/b.hpp": "namespace saccade { constexpr int kB{1}; }\n",
        "lib/saccade/core/kernels-inl.hpp": "namespace saccade { struct NotListed {}; }\n",
        "lib/saccade/core/internal/c.hpp": "namespace saccade { struct NotListed {}; }\n",
        "lib/saccade/io/clouds/CMakeLists.txt": "saccade_room(io_clouds SOURCES a.cpp)\n",
        "lib/saccade/io/clouds/ply.hpp": "namespace saccade { class Ply; class PlyReader { int x; }; }\n",
    }


class Declarations(unittest.TestCase):
    def test_of_every_kind(self):
        self.maxDiff = None
        self.assertEqual(dict(declarations.declarations(HEADER)), NAMES)

    def test_braces_that_do_not_match(self):
        for text in ["namespace saccade {", "namespace saccade { void f() { }", "namespace saccade { } }", "void f() { ) }"]:
            with self.assertRaises(declarations.Unbalanced):
                declarations.declarations(text)


class CheckApi(unittest.TestCase):
    def run_check(self, root, *options):
        done = subprocess.run([sys.executable, "-B", "check_api.py", *options, root], capture_output=True, text=True,
                              timeout=60)
        return done.returncode, done.stdout

    def after(self, changes):
        """Writes the list of the small library, changes files (None: removes them), and checks."""
        with tempfile.TemporaryDirectory() as root:
            self.plant(root, library())
            self.assertEqual(self.run_check(root, "--write")[0], 0)
            self.assertEqual(self.run_check(root), (0, "3 headers, 4 public names\n"))
            self.plant(root, changes)
            status, output = self.run_check(root)
            self.assertEqual(self.run_check(root, "--write")[0], 0)
            self.assertEqual(self.run_check(root)[0], 0)
            return status, output.splitlines()

    def plant(self, root, files):
        for name, text in files.items():
            path = pathlib.Path(root) / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.unlink() if text is None else path.write_text(text)

    def expect(self, changes, *lines):
        status, output = self.after(changes)
        self.assertEqual((status, output[:-2]), (1, list(lines)))
        self.assertIn("tests/layers/check_api.py --write ROOT", output[-2])

    def test_unchanged_api_passes(self):
        more = "// more\nnamespace saccade {\nvoid f(int, int);\nstruct A { int x; };\nclass D;\n}\n"
        self.assertEqual(self.after({"lib/saccade/core/a.hpp": more})[0], 0)

    def test_added(self):
        self.expect({"lib/saccade/core/b.hpp": "namespace saccade { constexpr int kB{1}; int g(); }\n"},
                    "added: function g in saccade/core/b.hpp")

    def test_removed(self):
        self.expect({"lib/saccade/core/b.hpp": "namespace saccade {}\n"}, "removed: constant kB of saccade/core/b.hpp")

    def test_removed_with_its_header(self):
        self.expect({"lib/saccade/core/b.hpp": None}, "removed: constant kB of saccade/core/b.hpp")

    def test_made_internal(self):
        self.expect({"lib/saccade/core/b.hpp": None, "lib/saccade/core/internal/b.hpp": library()["lib/saccade/core/b.hpp"]},
                    "removed: constant kB of saccade/core/b.hpp")

    def test_moved(self):
        self.expect({"lib/saccade/core/b.hpp": None, "lib/saccade/io/clouds/b.hpp": library()["lib/saccade/core/b.hpp"]},
                    "moved: constant kB, from saccade/core/b.hpp to saccade/io/clouds/b.hpp")

    def test_kind_changed(self):
        self.expect({"lib/saccade/core/a.hpp": "namespace saccade { class A {}; void f(int); }\n"},
                    "removed: struct A of saccade/core/a.hpp", "added: class A in saccade/core/a.hpp")

    def test_unreadable_header(self):
        with tempfile.TemporaryDirectory() as root:
            self.plant(root, library() | {"lib/saccade/core/d.hpp": "namespace saccade {\n"})
            self.assertEqual(check_api.names_of(pathlib.Path(root))[1], ["lib/saccade/core/d.hpp: a } is missing"])

    def test_no_list(self):
        with tempfile.TemporaryDirectory() as root:
            self.plant(root, library())
            self.assertEqual(self.run_check(root)[0], 1)


if __name__ == "__main__":
    unittest.main()
