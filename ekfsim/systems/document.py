"""Which reading of a document a run follows, where print, code and the right equation differ."""

from typing import Literal, get_args

DocumentReading = Literal["printed", "coded", "corrected"]
READINGS: tuple[DocumentReading, ...] = get_args(DocumentReading)
