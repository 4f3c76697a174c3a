#!/usr/bin/env python3
"""Finds missing #include lines, which precompiled headers and unity builds hide.

A name of the table below needs one of its headers, and a type that one of our headers defines needs that header (or a
forward declaration): in the file itself or in what it includes of ours. Prints each fault, and exits with 1 if there
is one. It knows names, not C++: the build without -DLIMPID_PCH and -DLIMPID_UNITY has the last word.
"""

import collections
import os
import re
import subprocess
import sys

ROOTS = ("src", "apps", "include", "python/src", "")

# Pattern of a name: the headers that declare it.
NAMES = {
    r"std::(?:any_of|all_of|none_of|count_if|find_if|copy|copy_n|fill|fill_n|transform|sort|stable_sort|nth_element|"
    r"min|max|clamp|minmax|min_element|max_element|lower_bound|upper_bound|equal|reverse|unique|ranges::\w+)\b":
        "algorithm",
    r"std::array\b": "array",
    r"std::(?:atomic\w*|memory_order\w*)\b": "atomic",
    r"std::(?:bit_cast|popcount|countl_zero|countr_zero|has_single_bit|bit_width|bit_ceil)\b": "bit",
    r"std::chrono\b": "chrono",
    r"std::(?:from_chars|to_chars)\b": "charconv",
    r"std::(?:sqrt|pow|exp|exp2|log|log2|log10|sin|cos|tan|acos|asin|atan2?|floor|ceil|round|lround|fmod|hypot|isfinite|"
    r"isnan|isinf|cbrt|ldexp|frexp|nextafter|copysign)\b": "cmath",
    r"std::condition_variable": "condition_variable",
    r"std::mem(?:cpy|set|cmp|move)\b": "cstring",
    r"std::deque\b": "deque",
    r"std::(?:filesystem|error_code)\b": "filesystem system_error",
    r"std::(?:ifstream|ofstream|fstream)\b": "fstream",
    r"std::(?:function|hash|less|greater)\b": "functional string",
    r"std::(?:future|promise|async|packaged_task)\b": "future",
    r"std::numeric_limits\b": "limits",
    r"std::map\b": "map",
    r"std::(?:unique_ptr|shared_ptr|weak_ptr|make_unique|make_shared)\b": "memory",
    r"std::(?:mutex|lock_guard|unique_lock|scoped_lock|once_flag)\b": "mutex",
    r"std::numbers::": "numbers",
    r"std::(?:accumulate|iota|reduce|gcd|partial_sum|inner_product|midpoint)\b": "numeric",
    r"std::(?:optional|nullopt)\b": "optional",
    r"std::(?:mt19937\w*|random_device|uniform_\w+_distribution|normal_distribution)\b": "random",
    r"std::set\b": "set",
    r"std::span\b": "span",
    r"std::[io]?stringstream\b": "sstream",
    r"std::(?:runtime_error|logic_error|invalid_argument|out_of_range)\b": "stdexcept",
    r"std::(?:string|to_string|getline)\b": "string",
    r"std::string_view\b": "string_view string",
    r"std::(?:thread|jthread|this_thread)\b": "thread",
    r"std::(?:variant|visit|monostate|holds_alternative|get_if)\b": "variant",
    r"std::vector\b": "vector",
    r"fmt::(?:format|print|format_to|memory_buffer|runtime)\b": "fmt/format.h fmt/ranges.h",
    r"glm::": "glm/glm.hpp glm/gtc/packing.hpp",
    r"nlohmann::": "nlohmann/json.hpp nlohmann/json_fwd.hpp",
}
NAMES = [(re.compile(r"(?<![\w:])" + pattern), set(headers.split())) for pattern, headers in NAMES.items()]

INCLUDE = re.compile(r'^#\s*include\s+[<"]([^>"]+)[>"]', re.M)
# Names of one word (Start, Window) are often other things, too.
DEFINITION = re.compile(r"^(?:class|struct|enum class|enum)\s+(?:\[\[\w+\]\]\s+)?([A-Z][a-z]\w*[A-Z]\w*)[^;{(]*\{", re.M)
FORWARD = re.compile(r"\b(?:class|struct|enum class|enum|using|typename)\s+([A-Z]\w+)\b")
USE = re.compile(r"(?<![\w:.>])([A-Z]\w+)(?=\s*[&*>{(]|::|\s+\w)")  # and not a value of an enumeration
FRAGMENT = re.compile(r"flip_\w+_impl\.h$")
OTHERS = {"ClientMessage"}  # of X11
TEXTS = re.compile(r'//[^\n]*|/\*.*?\*/|R"\((?:.|\n)*?\)"|"(?:\\.|[^"\\\n])*"', re.S)


class Files:
    def __init__(self):
        listed = subprocess.run(["git", "ls-files", "-c", "-o", "--exclude-standard", "--", "*.h", "*.cpp"],
                                capture_output=True, text=True, check=True).stdout.split()
        # Fragments are included inside a namespace and have no includes of their own.
        self.names = {name for name in listed if os.path.exists(name) and not FRAGMENT.search(name)}
        self.ours, self.foreign, self.code = {}, {}, {}
        for name in self.names:
            with open(name, encoding="utf-8") as file:
                text = file.read()
            ours, foreign = [], set()
            for included in INCLUDE.findall(text):
                found = self.find(included, name)
                ours.append(found) if found else foreign.add(included)
            self.ours[name], self.foreign[name] = ours, foreign
            self.code[name] = TEXTS.sub(" ", INCLUDE.sub("", text))

    def find(self, included, name):
        for root in (*ROOTS, os.path.dirname(name)):
            path = os.path.normpath(os.path.join(root, included))
            if path in self.names:
                return path
        return None

    def reached(self, name):
        """What `name` includes of ours, itself among it, and all foreign headers that these name."""
        ours, waiting = set(), [name]
        while waiting:
            file = waiting.pop()
            if file in ours:
                continue
            ours.add(file)
            waiting += self.ours[file]
            if "method_list.h" in self.foreign[file]:  # generated
                waiting += [method for method in self.names if method.startswith("src/denoise/methods/")]
        return ours, set().union(*(self.foreign[file] for file in ours))


def faults(files):
    definitions = collections.defaultdict(set)
    for name in files.names:
        if name.endswith(".h"):
            for type_name in DEFINITION.findall(files.code[name]):
                definitions[type_name].add(name)
    for name in sorted(files.names):
        ours, foreign = files.reached(name)
        code = files.code[name]
        for pattern, headers in NAMES:
            used = pattern.search(code)
            if used and not headers & foreign:
                yield f"{name}: {used.group()} needs <{sorted(headers)[0]}>"
        known = set(FORWARD.findall(code))
        known.update(*(FORWARD.findall(files.code[file]) for file in ours))
        for word in sorted(set(USE.findall(code)) - known - OTHERS):
            if word in definitions and not definitions[word] & ours:
                yield f"{name}: {word} needs \"{sorted(definitions[word])[0]}\""


def main():
    os.chdir(os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
    found = list(faults(Files()))
    for fault in found:
        print(fault)
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
