"""A small scan in E57, written by libE57Format: three points, turned about z and shifted."""

import base64
import zlib

PACKED = (
    "eNrtV8uO40QUzUisWiCxZGkssUKOH3nYDYkzId2taTShR9OhmYdGomLfpAtsVyhXHh2ENDvEDgmJNZ/CP/AD8x9suH4kKSfuJDMb"
    "NuOWZbfr3HNP3UdVpXs96GvnDftBJb8+zh6/5/8++Sh/+SB7rHDfr8YrxetBpYPQD/O/SuV1B++HlcobvCt4/5U8u/iKz7/x/gTf"
    "X7v4rZNhW51FGCgz4DFlUVs1q4aqQOQxn0bjtvrt4EJz1I570oKG/ZQxoYi7CbTVa8GnnphyUE+U1YU8UdxWb4WYfKHr8/m8SmIR"
    "Vhkf672rfv9yoOO0dcswDQ3JtFniykXz1ojxkIhvSAgbdvSuuq1PX/bOuoPuyy4GTUFrpXamXIZkjKPKGRFEuaABvHrltvQNR0o5"
    "nlL/PrKf/Zpp+Z450ny7aWp1z7Q1YhsG/msaZDiqO4bR/CVlTWhSvjw+ffID4znvZSRgDFx1zZYuDxfwNNrB6ykAI/CYDjnhdzcZ"
    "9D61k7skWEa1XjVPU007limfxxjHlBEBfRDET2JTIMy8ehyIQBOMHQyoHO88m26azpafj9+QYLoCXQSMiIwHETTuChZSrxcw78en"
    "MAKORQN+6Vz1bbfp10QjpjMzuAFPMK4qJAjY/BEI4GwMEbBp3LulgY/kWJordbMUnA7cM4FDFVC3oN5wmkPNNgjR6lZtqDkmVoDj"
    "m6RmDRt2Y+gXKyDljPaU6LVHIsVIbaK8ClMbAeEEOEnEKfE/3/1aEkxEcQgwQjN4NA2pT8WdUg4jImTx5BY49Z5wiOOEtBzpQ+xx"
    "OhGHKkuZSaUlGa2JaOTD4is2jfz43mAnE2BzLHYaTsOyEpBAZFECcq2WvhmULDwWTMPoMHOOKyUvKAAUfgRfjtvP19Kl4EgBExDF"
    "mMPHNKRib9DW0KKgLJeuVW2AZpiJlyKslKEgNWco2BZjK41kOtcDHuECYkqiw0lflOo+rTrweaJ7sat3UarztGqtLHYqoDw2uHcU"
    "LwsrqCQ+5XGxt62d08R6x/ey1HetzHq563u54/vrP8Lfsvk2CgSm7SQM2xnaysR6YMJi2N+LghQbfweDqPlOTHD7a9qOaTrNRt1u"
    "2LWs+uYFq0X5epMFe8/Y8khvS2ke+moi0jfBSRQHR0xvsVUwWGBYIot3FCyvDbqkYZOsJCmbddr7aUqxtxBxLTCL+7J1cK992/02"
    "07MtoUzbeeT/v8pQgFTVuCKtlpseCyfJBgf+6mQwwpPe1WgUg2irdUdVOHh44ulhZ+CHmix7gmXDEpr9BbLurmeFqSno16PZYTjG"
    "DTMAVQmz3k6OIEqYdWlbtVW3LvXos3Ly5zL5m+6/n+13YEkOHNVtSA6elzt4cbz6mkSOS5DqNquW7OFFwcN6fzjeQb5jSW7Msm1M"
    "7qV1sgqbuQ9e/A4nw3zZTM3lzkwKKz876tLhMTucZufQ9J3iTwuIrbc/lOLkclP8paTnP5Xck/f9/77/ZfIvz6/+/A900coH"
)
SCAN = zlib.decompress(base64.b64decode(PACKED))
POINTS = ((98.0, 1.0, 3.0), (95.0, 4.0, 6.0), (92.0, 7.0, 9.5))
INTENSITIES = (0.25, 0.5, 1.0)
