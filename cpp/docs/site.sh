#!/usr/bin/env bash
# Builds the documentation as a site in build/site: these pages, the examples and notebooks, executed, and the references
# of Python, from its docstrings, and of C++, by Doxygen. Warnings are errors: a link without a target, a page outside the
# navigation, a public name without words, an example that fails.
set -euo pipefail
programs=(doxygen)
source "$(dirname "${BASH_SOURCE[0]}")/../../python/setup.sh" "${1:-demo}"
"$python" -m pip install -q --disable-pip-version-check "mkdocs-material>=9.5,<10" "ipykernel>=6" "nbclient>=0.8" "nbconvert>=7"
mkdir -p "$root/build/doxygen"
(cd "$root" && doxygen cpp/docs/site/Doxyfile)
if grep -E 'Compound [^<]* is not|\((function|enumeration)\) of namespace' "$root/build/doxygen/warnings.txt" >&2; then
  fail "these names need a comment in their header"
fi
NO_MKDOCS_2_WARNING=1 "$python" -m mkdocs build --strict --config-file "$root/cpp/mkdocs.yml"
cp -r "$root/build/doxygen/html" "$root/build/site/cpp"
echo "written to build/site: index.html"
