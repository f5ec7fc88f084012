"""Tell PyInstaller what shaftprint imports by name and late, and which files it reads."""

from PyInstaller.utils.hooks import collect_data_files, collect_submodules, copy_metadata

# numba keeps compiled code beside the age of its source, and some modules are run as files
module_collection_mode = "py"
# migrations of the store are found as files
datas = collect_data_files("shaftprint", include_py_files=True) + copy_metadata("shaftprint")
hiddenimports = collect_submodules("shaftprint")
# what is imported where it is needed, by its name
for package in ("asammdf", "asyncua", "can", "canmatrix", "matio", "nptdms", "psycopg", "pymodbus", "pyuff"):
    hiddenimports += collect_submodules(package)
    datas += collect_data_files(package)
for package in ("plotly", "reportlab", "dwdatareader", "alembic"):
    datas += collect_data_files(package, excludes=["**/labextension/**"])
hiddenimports += [
    "aiomqtt", "alembic.command", "alembic.config", "argon2", "defusedxml.ElementTree", "dwdatareader", "itsdangerous",
    "numba", "numexpr", "paho.mqtt.packettypes", "paho.mqtt.properties", "plotly", "psycopg_binary", "reportlab",
    "sqlalchemy.dialects.sqlite", "sqlalchemy.dialects.postgresql.psycopg", "starlette", "uvicorn", "xlsxwriter",
]  # fmt: skip
