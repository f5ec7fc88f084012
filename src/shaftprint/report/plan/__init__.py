"""The page of a planned test: first page, card for the bridge, charts."""
