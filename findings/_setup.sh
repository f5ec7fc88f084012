# shellcheck shell=bash
# Sourced by every find: "packages NAME==VERSION ..." makes an environment in a temporary folder, removed at the end,
# "run" runs the Python text that follows in it.
set -euo pipefail
findings=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

packages() {
	local python=${PYTHON:-python3}
	if command -v uv >/dev/null; then
		uv venv --quiet --python "$python" "$scratch/venv"
		uv pip install --quiet --python "$scratch/venv/bin/python" --constraint "$findings/versions.txt" "$@"
	else
		"$python" -m venv "$scratch/venv"
		"$scratch/venv/bin/pip" install --quiet --no-compile --disable-pip-version-check --constraint "$findings/versions.txt" "$@"
	fi
}

run() {
	(cd "$scratch" && PYTHONPATH=$findings PYTHONWARNINGS=ignore PYTHONDONTWRITEBYTECODE=1 OPENBLAS_NUM_THREADS=1 MPLBACKEND=Agg venv/bin/python -)
}
