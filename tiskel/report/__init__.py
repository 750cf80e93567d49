"""The page that `tiskel run` ends with: what went in, what happened, what came out, in words, numbers and pictures."""
