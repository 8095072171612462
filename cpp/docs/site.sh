#!/usr/bin/env bash
# Builds the documentation as a site in build/site: these pages, and the reference of Python from its docstrings.
# Warnings are errors: a link without a target, a page outside the navigation, a public name without a docstring.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../../python/setup.sh" "${1:-demo}"
"$python" -m pip install -q --disable-pip-version-check "mkdocs>=1.6,<2"
"$python" -m mkdocs build --quiet --strict --config-file "$root/cpp/mkdocs.yml"
echo "written to build/site: index.html"
