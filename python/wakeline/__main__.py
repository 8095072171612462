"""``python -m wakeline`` is the ``wakeline`` command."""

import sys

from wakeline.cli import main

sys.exit(main())
