"""Is a person recognised by the spectrum of a brain structure? Identification and reliability over changes that people undergo."""
