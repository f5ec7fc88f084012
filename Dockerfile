# shaftprint where no Python is to be had: Debian slim, a user without privileges, the versions and hashes of requirements/.
# docs/installation.md says how it is built and used.
FROM python:3.13-slim-trixie AS build
WORKDIR /source
COPY requirements/readers.txt requirements/
RUN python -m venv /opt/shaftprint
RUN /opt/shaftprint/bin/pip install --no-cache-dir --no-deps --require-hashes --requirement requirements/readers.txt
COPY pyproject.toml README.md LICENSE ./
COPY src src
RUN /opt/shaftprint/bin/pip install --no-cache-dir --no-deps --no-build-isolation .

FROM python:3.13-slim-trixie
COPY --from=build /opt/shaftprint /opt/shaftprint
RUN useradd --create-home --uid 1000 shaftprint
USER shaftprint
# an image that cannot identify is not built; the compiled code of its user is kept in the image
RUN folder=$(mktemp -d) && /opt/shaftprint/bin/shaftprint demo --short --no-progress --output "$folder/demo" && rm -r "$folder"
WORKDIR /data
ENTRYPOINT ["/opt/shaftprint/bin/shaftprint"]
CMD ["--help"]
