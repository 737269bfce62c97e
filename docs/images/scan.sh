#!/usr/bin/env bash
# Makes the pictures of docs/guide-scan.md, by the test that runs its commands.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
HAPTRIAL_KEEP_PICTURES=$PWD/docs/images build/test_experiments --gtest_filter='ScanGuideTest.*'
